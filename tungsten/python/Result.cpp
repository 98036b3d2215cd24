#include "tungsten/python/Result.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/io/Result.h"
#include "tungsten/session/Report.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

namespace tungsten::python {

namespace py = pybind11;

namespace {

/// All frames, one after the other.
template <typename Frame>
std::vector<float> arrayOf(const Film& film, const Scene& scene, const Frame& frameOf) {
    std::vector<float> values;
    values.reserve(size_t(film.frames()) * size_t(film.height()) * size_t(film.width()) *
                   size_t(film.contents().channels));
    for (int frame = 0; frame < film.frames(); ++frame)
        for (const float value : valuesOf(inOutputUnits(frameOf(frame), scene, 1), film.contents().channels))
            values.push_back(value);
    return values;
}

py::array viewOf(const std::vector<float>& values, const Film& film, const py::object& owner) {
    const std::vector<py::ssize_t> shape{film.frames(), film.height(), film.width(), film.contents().channels};
    py::array view(py::dtype::of<float>(), shape, values.data(), owner);
    view.attr("setflags")(py::arg("write") = false);
    return view;
}

py::array edgesOf(const Result& result) {
    const std::vector<double> edges = frameEdges(result.scene().transport.gate);
    return py::array_t<double>(py::ssize_t(edges.size()), edges.data());
}

py::object picosecondsOf(const Result& result) {
    const std::vector<double> edges = frameEdgesInPicoseconds(result.scene());
    if (edges.empty()) return py::none();
    return py::array_t<double>(py::ssize_t(edges.size()), edges.data());
}

py::object parsed(const Result& result) {
    return py::module_::import("json").attr("loads")(result.metadata());
}

std::string textOf(const Result& result) {
    const SessionResult& session = result.session();
    char text[160];
    std::snprintf(text, sizeof text, "<darts_tungsten.Result: %d frames of %d x %d pixels, %u passes, %s>",
                  session.film.frames(), session.film.width(), session.film.height(), session.film.passes(),
                  toString(session.reason).c_str());
    return text;
}

} // namespace

Result::Result(LoadedScene loaded, const SessionOptions& options, std::unique_ptr<const SessionResult> session)
    : loaded_(std::move(loaded)), session_(std::move(session)),
      metadata_(describeResult({*loaded_.scene, loaded_.integratorType, loaded_.text, options.command,
                                statisticsJson(loaded_, options, *session_)})),
      mean_(arrayOf(session_->film, scene(), [&](int frame) { return session_->film.mean(frame); })),
      standardError_(arrayOf(session_->film, scene(), [&](int frame) { return session_->film.standardError(frame); })),
      batchMeans_(tungsten::batchMeans(session_->film, scene()).values) {}

std::vector<std::string> Result::write(const std::filesystem::path& file) const {
    OutputFiles outputs;
    (hasFormat(file, output_use::Shown) ? outputs.ldr : outputs.hdr) = file;
    checkOutputs(outputs, {session_->film.frames(), false, false, loaded_.inputs});
    std::vector<std::string> names;
    for (const auto& written : writeImages(session_->film, session_->bias, scene(), outputs, metadata_))
        names.push_back(written);
    return names;
}

py::array Result::mean(const py::object& self) {
    const auto& result = self.cast<const Result&>();
    return viewOf(result.mean_, result.session_->film, self);
}

py::array Result::standardError(const py::object& self) {
    const auto& result = self.cast<const Result&>();
    return viewOf(result.standardError_, result.session_->film, self);
}

py::object Result::batchMeans(const py::object& self) {
    const auto& result = self.cast<const Result&>();
    const BatchMeans& batches = result.session_->film.batches();
    if (batches.count() == 0) return py::none();
    const std::vector<py::ssize_t> shape{batches.count(), result.session_->film.frames(), batches.rows(),
                                         batches.columns(), result.session_->film.contents().channels};
    py::array view(py::dtype::of<float>(), shape, result.batchMeans_.data(), self);
    view.attr("setflags")(py::arg("write") = false);
    return view;
}

void declareResult(py::module_& module) {
    const auto property = [](auto get) { return py::cpp_function(get); };
    py::class_<Result> result(module, "Result", "What a render left; docs/results.md says what the arrays are.");
    // Methods of one that holds nothing would read what is not there.
    result.attr("__new__") = py::cpp_function(
        [](const py::args&, const py::kwargs&) -> py::object { throw py::type_error("Result: render() makes it"); });
    result.def_property_readonly("mean", property(&Result::mean), "(frames, height, width, channels), a read-only view")
        .def_property_readonly("standard_error", property(&Result::standardError),
                               "of mean, a read-only view; NaN while there is but one pass")
        .def_property_readonly("batch_means", property(&Result::batchMeans),
                               "(batches, frames, rows, columns, channels) of blocks, a read-only view; None where the "
                               "scene has no film.batches")
        .def_property_readonly(
            "batch_weights",
            [](const Result& r) {
                const std::vector<double>& weights = r.session().film.batches().weights();
                return py::array_t<double>(py::ssize_t(weights.size()), weights.data());
            },
            "of passes, by batch")
        .def_property_readonly("time_edges", edgesOf, "frames + 1 times in the scene's unit")
        .def_property_readonly("time_edges_ps", picosecondsOf,
                               "the same in picoseconds; None where the scene does not say its length_unit")
        .def_property_readonly("metadata", parsed, "a dict: what a result file says about itself")
        .def_property_readonly("passes", [](const Result& r) { return r.session().film.passes(); })
        .def_property_readonly(
            "samples", [](const Result& r) { return samplesOf(r.session()); },
            "per pixel; a fraction where passes were cut")
        .def_property_readonly(
            "seconds", [](const Result& r) { return r.session().renderSeconds; }, "of passes")
        .def_property_readonly(
            "reason", [](const Result& r) { return toString(r.session().reason); }, "why it ended")
        .def_property_readonly(
            "relative_error", [](const Result& r) { return relativeStandardError(r.session().film); },
            "rms standard error over mean; NaN while it is unknown")
        .def_property_readonly(
            "error_bound", [](const Result& r) { return relativeErrorBound(r.session().film); },
            "what the relative error does not exceed with a confidence of 95 %")
        .def("write", &Result::write, py::arg("file"), py::call_guard<py::gil_scoped_release>(),
             ("Writes " + formatsText(output_use::Linear | output_use::Shown) +
              " and what goes beside them; returns the names.")
                 .c_str())
        .def("__repr__", textOf);
}

py::object samplesOf(const SessionResult& session) {
    const double taken = session.film.totalWeight();
    return taken == double(session.samples) ? py::object(py::int_(session.samples)) : py::object(py::float_(taken));
}

} // namespace tungsten::python
