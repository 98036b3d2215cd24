// `darts_tungsten.sampling`: src/darts over numpy arrays, which broadcast against each other. Names and units are those
// of the headers.

#include "darts/python/Guides.h"

#include "darts/ConnectionLobe.h"
#include "darts/ControlVertex.h"
#include "darts/DistanceSampler.h"
#include "darts/EdaDensity.h"
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
    return darts::CausalGreensFunction<double>{sigmaA, sigmaS}.log((s - rho) * (s + rho) / (s * s), s);
}

double diffusionLog(double rho, double s, double sigmaA, double sigmaS, double g) {
    return darts::DiffusionGreensFunction<double>{sigmaA, sigmaS, g}.log(rho, s);
}

void declareConnections(py::module_& module) {
    module.def("first_leg", py::vectorize([](double C, double delta, double h) {
                   return Ellipse<double>{C, delta, h}.firstLeg();
               }),
               "t of the connection of length S = C + delta along a ray with h = 1 - cos to the target", "C"_a,
               "delta"_a, "h"_a);
    module.def("second_leg", py::vectorize([](double C, double delta, double h) {
                   return Ellipse<double>{C, delta, h}.secondLeg();
               }),
               "r = S - t", "C"_a, "delta"_a, "h"_a);
    module.def("connection_length_sample",
               py::vectorize([](double u, double low, double width, double sigmaT, double needle) {
                   return darts::ConnectionLength<double>{low, width, sigmaT, needle}.sample(u).offset;
               }),
               "S - low from u in [0, 1)", "u"_a, "low"_a, "width"_a, "sigma_t"_a, "needle"_a = 0.0);
    module.def("connection_length_pdf",
               py::vectorize([](double offset, double low, double width, double sigmaT, double needle) {
                   return darts::ConnectionLength<double>{low, width, sigmaT, needle}.pdf(offset);
               }),
               "density per length of S = low + offset", "offset"_a, "low"_a, "width"_a, "sigma_t"_a, "needle"_a = 0.0);
    module.def("control_vertex_pdf", py::vectorize([](double C, double delta, double h, double lengthPdf) {
                   return darts::controlVertexPdf(Ellipse<double>{C, delta, h}, lengthPdf);
               }),
               "density per length along the ray of the vertex of a connection whose length has that density", "C"_a,
               "delta"_a, "h"_a, "length_pdf"_a);
}

void declareDirections(py::module_& module) {
    const auto declareLobe = [&](const std::string& name, auto lobe) {
        module.def((name + "_sample").c_str(),
                   py::vectorize([lobe](double u, double C, double delta) { return lobe(C, delta).sample(u); }),
                   "h = 1 - cos to the target from u in [0, 1)", "u"_a, "C"_a, "delta"_a);
        module.def((name + "_pdf").c_str(),
                   py::vectorize([lobe](double h, double C, double delta) { return lobe(C, delta).pdf(h); }),
                   "density per solid angle", "h"_a, "C"_a, "delta"_a);
    };
    declareLobe("path_lobe", &darts::ConnectionLobe<double>::path);
    declareLobe("photon_lobe", &darts::ConnectionLobe<double>::photon);
    module.def("eda_log_density", py::vectorize(darts::edaLogDensity),
               "log of the elliptical diffusion approximation, lengths in mean free paths", "albedo"_a, "g"_a, "C"_a,
               "delta"_a, "h"_a);
    using darts::EdaTable;
    py::class_<EdaTable, std::shared_ptr<EdaTable>>(module, "EdaTable", "Directions by the published table.")
        .def(py::init([](float albedo, float g) { return std::make_shared<EdaTable>(EdaTable::build(albedo, g)); }),
             "albedo"_a, "g"_a)
        .def("sample", py::vectorize(&EdaTable::sample), "h from u in [0, 1)", "C"_a, "delta"_a, "sigma_t"_a, "u"_a)
        .def("pdf", py::vectorize(&EdaTable::pdf), "density per solid angle", "C"_a, "delta"_a, "sigma_t"_a, "h"_a);
}

/// Distances of one preset in one grey medium.
class Distances {
  public:
    Distances(const std::string& preset, const std::string& mode, float sigmaA, float sigmaS, float g)
        : sampler_(settingsOf(preset, mode, g), {{sigmaA, sigmaA, sigmaA}, {sigmaS, sigmaS, sigmaS}, g}) {
        if (!(sigmaA >= 0.0f && sigmaS >= 0.0f && std::abs(g) < 1.0f))
            throw py::value_error("expected coefficients of at least 0, and g between -1 and 1");
    }

    /// `random`: (n, 4) in [0, 1). Distances, and transmittance over density.
    [[nodiscard]] std::pair<py::array_t<float>, py::array_t<float>>
    sample(float C, double low, double high, float h, const py::array_t<float, py::array::c_style>& random,
           float surface) const {
        if (random.ndim() != 2 || random.shape(1) != 4) throw py::value_error("random: expected an array (n, 4)");
        if (!(h >= 0.0f && h <= 2.0f)) throw py::value_error("h: expected 1 - cos, from 0 to 2");
        const darts::Residual residual = darts::Residual::of({0.0f, 0.0f, C}, {low, high});
        const darts::Heading ray{{std::sqrt(h * (2.0f - h)), 0.0f, 1.0f - h}, h};
        const py::ssize_t count = random.shape(0);
        py::array_t<float> distances(count), weights(count);
        for (py::ssize_t i = 0; i < count; ++i) {
            const float* u = random.data(i, 0);
            const darts::DistanceSample sample =
                sampler_.sample(residual, ray, surface, {1.0f, 1.0f, 1.0f}, {u[0], u[1], u[2], u[3]});
            distances.mutable_at(i) = sample.distance;
            weights.mutable_at(i) = sample.transmittanceOverPdf.x;
        }
        return {distances, weights};
    }

  private:
    static darts::Settings settingsOf(const std::string& preset, const std::string& mode, float g) {
        if (mode != "path" && mode != "photon") throw py::value_error("mode: expected 'path' or 'photon'");
        const darts::Mode kind = mode == "path" ? darts::Mode::Path : darts::Mode::Photon;
        if (preset == "best") return darts::best(kind, g);
        if (preset == "published") return darts::published(kind);
        throw py::value_error("preset: expected 'best' or 'published'");
    }

    darts::DistanceSampler sampler_;
};

void declareDistances(py::module_& module) {
    py::class_<Distances>(module, "DistanceSampler", "Resampled distances to the next vertex, in a grey medium.")
        .def(py::init<const std::string&, const std::string&, float, float, float>(), "preset"_a, "mode"_a, "sigma_a"_a,
             "sigma_s"_a, "g"_a = 0.0f)
        .def("sample", &Distances::sample,
             "Draws for connections of lengths low to high to a target at distance C: (distances, transmittance over\n"
             "density), both (n,), from random numbers (n, 4). A distance equal to `surface` is the surface.",
             "C"_a, "low"_a, "high"_a, "h"_a, "random"_a, "surface"_a = std::numeric_limits<float>::infinity());
    using darts::TemporalResponse;
    py::class_<TemporalResponse>(module, "TemporalResponse", "A sensor's response to the time of arrival.")
        .def_static("box", &TemporalResponse::box, "begin"_a, "end"_a)
        .def_static("gaussian", &TemporalResponse::gaussian, "center"_a, "sigma"_a)
        .def_static("tabulated", &TemporalResponse::tabulated, "times"_a, "values"_a)
        .def("pdf", py::vectorize(&TemporalResponse::pdf), "density per time", "time"_a)
        .def("distribution", py::vectorize(&TemporalResponse::distribution), "its integral up to a time", "time"_a)
        .def("quantile", py::vectorize(&TemporalResponse::quantile), "inverse of distribution", "u"_a);
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
