// `darts_tungsten.sampling.Guide`: whole steps of a guided walk over numpy arrays; and first passage out of a body.

#include "darts/python/Guides.h"

#include "darts/python/Checks.h"

#include "darts/FirstPassage.h"
#include "darts/Guide.h"

#include <random>

namespace darts::python {

namespace py = pybind11;
using namespace py::literals;

darts::Medium mediumOf(float sigmaA, float sigmaS, float g) {
    notNegative(sigmaA, "sigma_a");
    notNegative(sigmaS, "sigma_s");
    if (!(std::abs(g) < 1.0f)) throw py::value_error("g: expected a number between -1 and 1, without them");
    return {{sigmaA, sigmaA, sigmaA}, {sigmaS, sigmaS, sigmaS}, g};
}

darts::Settings presetOf(const std::string& preset, const std::string& mode, float g) {
    if (mode != "path" && mode != "photon") throw py::value_error("mode: expected 'path' or 'photon'");
    const darts::Mode kind = mode == "path" ? darts::Mode::Path : darts::Mode::Photon;
    if (preset == "best") return darts::best(kind, g);
    if (preset == "published") return darts::published(kind);
    throw py::value_error("preset: expected 'best' or 'published'");
}

darts::TimeBudget residualOf(float C, double low, double high) {
    notNegative(C, "C");
    if (!(finite(high, "high") > finite(low, "low"))) throw py::value_error("low, high: expected high > low");
    return darts::TimeBudget::of({0.0f, 0.0f, C}, {low, high});
}

namespace {

/// Arrays of one length, under their names.
class Columns {
  public:
    explicit Columns(py::ssize_t rows) : rows_(rows) {}
    float* add(const char* name) {
        py::array_t<float> column(rows_);
        columns_[name] = column;
        return column.mutable_data();
    }
    [[nodiscard]] py::dict all() const { return columns_; }

  private:
    py::ssize_t rows_;
    py::dict columns_;
};

/// One kind of target in one grey medium: a vertex at the origin, its target on the axis z.
class GuideOfMedium {
  public:
    GuideOfMedium(const std::string& preset, const std::string& mode, float sigmaA, float sigmaS, float g)
        : guide_(presetOf(preset, mode, g), mediumOf(sigmaA, sigmaS, g)) {}

    /// One vertex's step, `count` times.
    [[nodiscard]] py::dict sample(float C, double low, double high, py::ssize_t count, uint64_t seed, float before,
                                  float surface) const {
        if (!(C > 0.0f)) throw py::value_error("C: expected a number above 0");
        if (count < 0) throw py::value_error("count: expected at least 0");
        cosine(before, "before");
        length(surface, "surface");
        const darts::TimeBudget budget = residualOf(C, low, high);
        if (!budget.alive()) throw py::value_error("high: expected more than C, as no connection is shorter");
        const darts::HenyeyGreenstein phase{{std::sqrt(before * (2.0f - before)), 0.0f, 1.0f - before},
                                            guide_.medium().g};
        Columns columns(count);
        float *lengths = columns.add("length"), *lengthWeights = columns.add("length_inverse_pdf"),
              *hs = columns.add("h"), *phases = columns.add("phase"),
              *directions = columns.add("direction_inverse_pdf"), *vertices = columns.add("vertex"),
              *legs = columns.add("to_target"), *vertexWeights = columns.add("vertex_inverse_pdf"),
              *distances = columns.add("distance"), *weights = columns.add("transmittance_over_pdf");
        std::mt19937_64 bits(seed);
        const auto random = [&bits] { return float(bits() >> 40) * 0x1p-24f; };
        for (py::ssize_t i = 0; i < count; ++i) {
            darts::ConnectionSample connection = guide_.sampleConnection(budget, random());
            const darts::DirectionSample ray = guide_.sampleDirection(budget, connection, phase, random);
            if (!guide_.settings().lengthFirst) connection = guide_.sampleConnectionAlong(budget, ray.h, random());
            const auto vertex = guide_.controlVertex(budget, connection, ray.h, surface);
            const darts::DistanceSample step = guide_.sampleDistance(budget, ray, surface, {1.0f, 1.0f, 1.0f}, random);
            lengths[i] = C + connection.excess;
            lengthWeights[i] = connection.inversePdf;
            hs[i] = ray.h;
            phases[i] = phase.pdf(ray.direction);
            directions[i] = ray.inversePdf;
            vertices[i] = vertex ? vertex->distance : NAN;
            legs[i] = vertex ? vertex->toTarget : NAN;
            vertexWeights[i] = vertex ? vertex->inversePdf : 0.0f;
            distances[i] = step.distance;
            weights[i] = step.transmittanceOverPdf.x;
        }
        return columns.all();
    }

    [[nodiscard]] float vertexPdf(float C, double low, double high, float h, float distance) const {
        const darts::TimeBudget budget = residualOf(C, low, high);
        cosine(h);
        notNegative(distance, "distance");
        return budget.alive() ? guide_.pdfControlVertex(budget, h, distance) : 0.0f;
    }
    [[nodiscard]] float logExpectedContribution(float C, double low, double high, float throughput) const {
        const darts::TimeBudget budget = residualOf(C, low, high);
        notNegative(throughput, "throughput");
        return budget.alive() ? guide_.logExpectedContribution(budget, throughput)
                              : -std::numeric_limits<float>::infinity();
    }

  private:
    darts::Guide guide_;
};

/// Under the plane boundary of a half-space or slab, the target straight above and far away.
double firstPassageLog(double depth, double longest, double gate, double sigmaA, double reducedS, double thickness,
                       double relativeIndex, double allowance) {
    constexpr double Height = 1.0;
    notNegative(depth, "depth");
    finite(longest, "longest");
    notNegative(gate, "gate");
    notNegative(sigmaA, "sigma_a");
    notNegative(reducedS, "reduced_sigma_s");
    length(thickness, "thickness");
    within(relativeIndex, "relative_index", 1e-3, 1e3);
    notNegative(allowance, "allowance");
    darts::TimeBudget budget =
        darts::TimeBudget::of({0.0f, 0.0f, float(depth + Height)}, {Height + longest - gate, Height + longest});
    budget.model = darts::EscapeModel::Bounded;
    budget.escape.faces.add({{0, 0, 1}, float(depth), float(Height), float(thickness), 0.0f});
    budget.escape.inside = float(depth);
    budget.escape.reflectionA = darts::boundaryReflectionA(float(relativeIndex));
    if (!budget.alive()) return -std::numeric_limits<double>::infinity();
    const darts::FirstPassage passage(float(sigmaA), float(reducedS), budget.escape, float(allowance));
    return double(passage.log({budget.escape, budget.latest(0), budget.axis, 0.0f}));
}

} // namespace

void declareGuides(py::module_& sampling) {
    py::class_<GuideOfMedium> guide(
        sampling, "Guide", "What a guided walk draws at a vertex, for a target at distance C, in a grey medium.");
    makeWhole(guide);
    guide
        .def(py::init<const std::string&, const std::string&, float, float, float>(), "preset"_a, "mode"_a, "sigma_a"_a,
             "sigma_s"_a, "g"_a = 0.0f)
        .def(
            "sample", &GuideOfMedium::sample,
            "A dict of arrays (count,): `length` of the next connection (low to high) and 1 / its density per length;\n"
            "`h` = 1 - cos between the next direction and the target, `phase` of it, and 1 / its density per solid\n"
            "angle; `vertex`, the control vertex's distance along the ray (NaN: none), `to_target` from there, and 1 "
            "/\n"
            "its density per length; `distance` to the next vertex of the walk, and transmittance over density.\n"
            "`before` is 1 - cos between the direction that the walk came in and the target.",
            "C"_a, "low"_a, "high"_a, "count"_a, "seed"_a = uint64_t(0), "before"_a = 0.0f,
            "surface"_a = std::numeric_limits<float>::infinity())
        .def("vertex_pdf", py::vectorize(&GuideOfMedium::vertexPdf),
             "density per length along the ray of the control vertex", "C"_a, "low"_a, "high"_a, "h"_a, "distance"_a)
        .def("log_usefulness", py::vectorize(&GuideOfMedium::logExpectedContribution),
             "log of what a walk with this throughput is good for here", "C"_a, "low"_a, "high"_a,
             "throughput"_a = 1.0f);
    sampling.def(
        "first_passage_log", py::vectorize(firstPassageLog),
        "log of the probability that light diffusing from `depth` under the boundary of a half-space (or slab\n"
        "of `thickness`) leaves it after paths of at most `longest`, and no more than `gate` less",
        "depth"_a, "longest"_a, "gate"_a, "sigma_a"_a, "reduced_sigma_s"_a,
        "thickness"_a = std::numeric_limits<double>::infinity(), "relative_index"_a = 1.0, "allowance"_a = 1.0);
}

} // namespace darts::python
