// `darts_tungsten.sampling`: src/darts over numpy arrays, which broadcast against each other. Names and units are those
// of the headers.

#include "darts/python/Checks.h"
#include "darts/python/Guides.h"

#include "darts/ConnectionLobe.h"
#include "darts/ControlVertex.h"
#include "darts/DistanceSampler.h"
#include "darts/EdaTable.h"
#include "darts/GreensFunction.h"
#include "darts/TemporalResponse.h"

#include <pybind11/stl.h>

namespace darts::python {

namespace py = pybind11;
using namespace py::literals;

namespace {

using darts::Ellipse;

double causalLog(double rho, double s, double sigmaA, double sigmaS) {
    notNegative(rho, "rho");
    notNegative(s, "s");
    return darts::CausalGreensFunction<double>{notNegative(sigmaA, "sigma_a"), notNegative(sigmaS, "sigma_s")}.log(
        (s - rho) * (s + rho) / (s * s), s);
}

double diffusionLog(double rho, double s, double sigmaA, double sigmaS, double g) {
    const darts::DiffusionGreensFunction<double> greens{notNegative(sigmaA, "sigma_a"), notNegative(sigmaS, "sigma_s"),
                                                        within(g, "g", -1.0, 1.0)};
    return greens.log(notNegative(rho, "rho"), notNegative(s, "s"));
}

Ellipse<double> ellipse(double C, double delta, double h) {
    return {notNegative(C, "C"), notNegative(delta, "delta"), cosine(h)};
}

darts::ConnectionLength<double> connectionLength(double low, double width, double sigmaT, double needle) {
    return {notNegative(low, "low"), length(width, "width"), notNegative(sigmaT, "sigma_t"),
            notNegative(needle, "needle")};
}

double edaLogDensity(double albedo, double g, double C, double delta, double h) {
    return darts::edaLogDensity(within(albedo, "albedo", 0.0, 1.0), within(g, "g", -1.0, 1.0), notNegative(C, "C"),
                                notNegative(delta, "delta"), cosine(h));
}

void declareConnections(py::module_& module) {
    module.def("first_leg",
               py::vectorize([](double C, double delta, double h) { return ellipse(C, delta, h).firstLeg(); }),
               "t of the connection of length S = C + delta along a ray with h = 1 - cos to the target", "C"_a,
               "delta"_a, "h"_a);
    module.def("second_leg",
               py::vectorize([](double C, double delta, double h) { return ellipse(C, delta, h).secondLeg(); }),
               "r = S - t", "C"_a, "delta"_a, "h"_a);
    module.def("connection_length_sample",
               py::vectorize([](double u, double low, double width, double sigmaT, double needle) {
                   return connectionLength(low, width, sigmaT, needle).sample(random(u)).offset;
               }),
               "S - low from u in [0, 1)", "u"_a, "low"_a, "width"_a, "sigma_t"_a, "needle"_a = 0.0);
    module.def("connection_length_pdf",
               py::vectorize([](double offset, double low, double width, double sigmaT, double needle) {
                   return connectionLength(low, width, sigmaT, needle).pdf(finite(offset, "offset"));
               }),
               "density per length of S = low + offset", "offset"_a, "low"_a, "width"_a, "sigma_t"_a, "needle"_a = 0.0);
    module.def("control_vertex_pdf", py::vectorize([](double C, double delta, double h, double lengthPdf) {
                   return darts::controlVertexPdf(ellipse(C, delta, h), notNegative(lengthPdf, "length_pdf"));
               }),
               "density per length along the ray of the vertex of a connection whose length has that density", "C"_a,
               "delta"_a, "h"_a, "length_pdf"_a);
}

void declareDirections(py::module_& module) {
    const auto declareLobe = [&](const std::string& name, auto unchecked) {
        const auto lobe = [unchecked](double C, double delta) {
            return unchecked(notNegative(C, "C"), notNegative(delta, "delta"));
        };
        module.def((name + "_sample").c_str(),
                   py::vectorize([lobe](double u, double C, double delta) { return lobe(C, delta).sample(random(u)); }),
                   "h = 1 - cos to the target from u in [0, 1)", "u"_a, "C"_a, "delta"_a);
        module.def((name + "_pdf").c_str(),
                   py::vectorize([lobe](double h, double C, double delta) { return lobe(C, delta).pdf(cosine(h)); }),
                   "density per solid angle", "h"_a, "C"_a, "delta"_a);
    };
    declareLobe("path_lobe", &darts::ConnectionLobe<double>::path);
    declareLobe("photon_lobe", &darts::ConnectionLobe<double>::photon);
    module.def("eda_log_density", py::vectorize(edaLogDensity),
               "log of the elliptical diffusion approximation, lengths in mean free paths", "albedo"_a, "g"_a, "C"_a,
               "delta"_a, "h"_a);
    using darts::EdaTable;
    const auto row = [](float C, float delta, float sigmaT) {
        notNegative(C, "C");
        notNegative(delta, "delta");
        notNegative(sigmaT, "sigma_t");
    };
    py::class_<EdaTable, std::shared_ptr<EdaTable>> table(module, "EdaTable", "Directions by the published table.");
    makeWhole(table);
    table
        .def(py::init([](float albedo, float g) { return std::make_shared<EdaTable>(EdaTable::build(albedo, g)); }),
             "albedo"_a, "g"_a)
        .def("sample", py::vectorize([row](const EdaTable* of, float C, float delta, float sigmaT, float u) {
                 row(C, delta, sigmaT);
                 return of->sample(C, delta, sigmaT, random(u));
             }),
             "h from u in [0, 1)", "C"_a, "delta"_a, "sigma_t"_a, "u"_a)
        .def("pdf", py::vectorize([row](const EdaTable* of, float C, float delta, float sigmaT, float h) {
                 row(C, delta, sigmaT);
                 return of->pdf(C, delta, sigmaT, cosine(h));
             }),
             "density per solid angle", "C"_a, "delta"_a, "sigma_t"_a, "h"_a);
}

/// Distances of one preset in one grey medium.
class Distances {
  public:
    Distances(const std::string& preset, const std::string& mode, float sigmaA, float sigmaS, float g)
        : sampler_(presetOf(preset, mode, mediumOf(sigmaA, sigmaS, g).g), mediumOf(sigmaA, sigmaS, g)) {}

    /// `random`: (n, 4) in [0, 1). Distances, and transmittance over density.
    [[nodiscard]] std::pair<py::array_t<float>, py::array_t<float>>
    sample(float C, double low, double high, float h, const py::array_t<float, py::array::c_style>& random,
           float surface) const {
        if (random.ndim() != 2 || random.shape(1) != 4) throw py::value_error("random: expected an array (n, 4)");
        cosine(h);
        length(surface, "surface");
        const darts::TimeBudget budget = residualOf(C, low, high);
        const darts::Heading ray{{std::sqrt(h * (2.0f - h)), 0.0f, 1.0f - h}, h};
        const py::ssize_t count = random.shape(0);
        py::array_t<float> distances(count), weights(count);
        for (py::ssize_t i = 0; i < count; ++i) {
            darts::DistanceRandom u;
            for (int k = 0; k < 4; ++k) u.*Numbers[k] = python::random(random.at(i, k), "random");
            const darts::DistanceSample sample =
                budget.alive() ? sampler_.sample(budget, ray, surface, {1.0f, 1.0f, 1.0f}, u) : darts::DistanceSample();
            distances.mutable_at(i) = sample.distance;
            weights.mutable_at(i) = sample.transmittanceOverPdf.x;
        }
        return {distances, weights};
    }

  private:
    static constexpr float darts::DistanceRandom::*Numbers[] = {
        &darts::DistanceRandom::row, &darts::DistanceRandom::rotation, &darts::DistanceRandom::choice,
        &darts::DistanceRandom::event};

    darts::DistanceSampler sampler_;
};

std::vector<double> allFinite(std::vector<double> numbers, const char* name) {
    for (const double number : numbers) finite(number, name);
    return numbers;
}

void declareResponse(py::module_& module) {
    using darts::TemporalResponse;
    const double earliest = -std::numeric_limits<double>::infinity(), latest = -earliest;
    py::class_<TemporalResponse> response(module, "TemporalResponse", "A sensor's response to the time of arrival.");
    response.attr("__new__") = py::cpp_function([](const py::args&, const py::kwargs&) -> py::object {
        throw py::type_error("TemporalResponse: is made by box(), gaussian() or tabulated()");
    });
    response
        .def_static(
            "box",
            [](double begin, double end) {
                finite(begin, "begin");
                if (!(finite(end, "end") > begin)) throw py::value_error("end: expected a time after begin");
                return TemporalResponse::box(begin, end);
            },
            "begin"_a, "end"_a)
        .def_static(
            "gaussian",
            [](double center, double sigma) {
                finite(center, "center");
                return TemporalResponse::gaussian(center, within(sigma, "sigma", 1.0 / Largest, Largest));
            },
            "center"_a, "sigma"_a)
        .def_static(
            "tabulated",
            [](const std::vector<double>& times, const std::vector<double>& values) {
                return TemporalResponse::tabulated(allFinite(times, "times"), allFinite(values, "values"));
            },
            "times"_a, "values"_a)
        .def("pdf", py::vectorize([=](const TemporalResponse* of, double time) {
                 return of->pdf(within(time, "time", earliest, latest));
             }),
             "density per time", "time"_a)
        .def("distribution", py::vectorize([=](const TemporalResponse* of, double time) {
                 return of->distribution(within(time, "time", earliest, latest));
             }),
             "its integral up to a time", "time"_a)
        .def("quantile",
             py::vectorize([](const TemporalResponse* of, double u) { return of->quantile(within(u, "u", 0.0, 1.0)); }),
             "inverse of distribution", "u"_a);
}

void declareDistances(py::module_& module) {
    py::class_<Distances> sampler(module, "DistanceSampler",
                                  "Resampled distances to the next vertex, in a grey medium.");
    makeWhole(sampler);
    sampler
        .def(py::init<const std::string&, const std::string&, float, float, float>(), "preset"_a, "mode"_a, "sigma_a"_a,
             "sigma_s"_a, "g"_a = 0.0f)
        .def("sample", &Distances::sample,
             "Draws for connections of lengths low to high to a target at distance C: (distances, transmittance over\n"
             "density), both (n,), from random numbers (n, 4). A distance equal to `surface` is the surface.",
             "C"_a, "low"_a, "high"_a, "h"_a, "random"_a, "surface"_a = std::numeric_limits<float>::infinity());
    declareResponse(module);
}

} // namespace

void declareSampling(py::module_& sampling) {
    sampling.def("diffusion_log", py::vectorize(diffusionLog),
                 "log of the diffusion Green's function at distance rho after path length s", "rho"_a, "s"_a,
                 "sigma_a"_a, "sigma_s"_a, "g"_a = 0.0);
    sampling.def("causal_log", py::vectorize(causalLog),
                 "log of Paasschens' causal approximation, isotropic scattering", "rho"_a, "s"_a, "sigma_a"_a,
                 "sigma_s"_a);
    declareConnections(sampling);
    declareDirections(sampling);
    declareDistances(sampling);
    declareGuides(sampling);
}

} // namespace darts::python

PYBIND11_MODULE(sampling, module) {
    module.doc() = "Densities and samplers of src/darts over numpy arrays.";
    darts::python::declareSampling(module);
}
