// `import darts_tungsten`, whose package is in tungsten/python/darts_tungsten.

#include "tungsten/python/Result.h"

#include "tungsten/film/FilmErrors.h"
#include "tungsten/session/Progress.h"
#include "tungsten/session/Report.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <tbb/global_control.h>

#include <chrono>

namespace tungsten::python {

namespace py = pybind11;

namespace {

/// Of a scene's files; none: beside the scene.
using Folder = std::optional<std::filesystem::path>;

/// Loaded once; immutable from then on.
const Plugins& plugins() {
    static const Plugins loaded;
    return loaded;
}

std::string typeOf(const py::handle& value) {
    return py::type::handle_of(value).attr("__name__").cast<std::string>();
}

/// What JSON does not know as a scene means it: arrays and numbers of numpy as lists and numbers, paths as their names.
py::object plain(const py::object& value) {
    if (py::hasattr(value, "tolist")) return value.attr("tolist")();
    if (py::hasattr(value, "__fspath__")) return value.attr("__fspath__")();
    throw py::type_error("scene: a value of type " + typeOf(value) +
                         " has no place in a scene; accepted: dict, list, tuple, str, numbers, bool, None, numpy's "
                         "arrays and numbers, and paths");
}

std::string jsonOf(const py::handle& value) {
    return py::module_::import("json")
        .attr("dumps")(value, py::arg("default") = py::cpp_function(plain))
        .cast<std::string>();
}

void warn(const Problem& problem) {
    if (PyErr_WarnEx(PyExc_UserWarning, problem.text().c_str(), 1) != 0) throw py::error_already_set();
}

/// Ctrl-C becomes KeyboardInterrupt.
void lookForSignals() {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// Python's other threads run meanwhile.
Job loadJob(const std::filesystem::path& file, LoadOptions options, const Plugins& known) {
    const py::gil_scoped_release released;
    options.watch = LoadWatch(lookForSignals);
    return makeJob(file, options, known);
}

/// A scene as a dict, or the name of a file; `set` as --set takes it.
Job jobOf(const py::object& scene, const py::dict& set, const Folder& folder, bool allowOutside) {
    LoadOptions options{folder.value_or(""), {}, allowOutside};
    for (const auto& [path, value] : set) {
        if (!py::isinstance<py::str>(path)) throw py::type_error("set: expected names as keys, found " + typeOf(path));
        options.overrides.push_back(path.cast<std::string>() + "=" + jsonOf(value));
    }
    std::filesystem::path file = "scene";
    if (py::isinstance<py::dict>(scene))
        options.text = jsonOf(scene);
    else if (py::isinstance<py::str>(scene) || py::isinstance<py::bytes>(scene) || py::hasattr(scene, "__fspath__"))
        file = scene.cast<std::filesystem::path>();
    else
        throw py::type_error("scene: expected a dict or the name of a file, found " + typeOf(scene));
    for (const Problem& problem : plugins().problems) warn(problem);
    Job job = loadJob(file, options, plugins());
    for (const Problem& problem : job.loaded.diagnostics->warnings) warn(problem);
    return job;
}

/// When a render stops, as Python says it; what is none is the scene's.
struct Limits {
    std::optional<double> seconds;
    std::optional<int64_t> passes, samples;
    std::optional<double> targetError;
};

SessionOptions sessionOptions(const RendererSettings& renderer, const Limits& limits) {
    const auto require = [](bool positive, const char* name) {
        if (!positive) throw UsageError(std::string(name) + ": expected a number above 0");
    };
    require(limits.seconds.value_or(1.0) > 0.0, "seconds");
    constexpr int64_t Most = 1000000000000; // as --spp
    const auto requireCount = [](const std::optional<int64_t>& count, int64_t most, const char* name) {
        if (count && (*count < 1 || *count > most))
            throw UsageError(std::string(name) + ": expected a number from 1 to " + std::to_string(most));
    };
    requireCount(limits.passes, Most / renderer.sppStep, "passes");
    requireCount(limits.samples, Most, "samples");
    require(limits.targetError.value_or(1.0) > 0.0, "target_error");
    if (limits.passes && limits.samples) throw UsageError("passes, samples: say one of them");
    SessionOptions options;
    options.sppStep = renderer.sppStep;
    options.spp = limits.passes ? *limits.passes * renderer.sppStep : limits.samples.value_or(renderer.spp);
    options.timeoutSeconds = limits.seconds.value_or(renderer.timeoutSeconds);
    options.targetError = limits.targetError.value_or(0.0);
    options.quiet = true;
    return options;
}

py::dict stateOf(const SessionResult& session, const SessionOptions& options) {
    py::dict state;
    state["passes"] = session.film.passes();
    state["samples"] = samplesOf(session);
    state["total_samples"] = options.spp;
    state["relative_error"] = relativeStandardError(session.film);
    return state;
}

/// Between passes `progress` is called; where it says False, the render stops.
void listen(const SessionResult& session, const SessionOptions& options, const py::object& progress,
            std::atomic<bool>& interrupted) {
    lookForSignals();
    const py::gil_scoped_acquire gil;
    if (!PyCallable_Check(progress.ptr())) return;
    const py::object answer = progress(stateOf(session, options));
    if (answer.is(py::bool_(false))) interrupted = true;
}

Result render(const py::object& scene, const py::dict& set, const Limits& limits, uint64_t seed,
              std::optional<int> threads, const py::object& progress, const Folder& folder, bool allowOutside) {
    if (threads && (*threads < 1 || *threads > 1024)) throw UsageError("threads: expected a number from 1 to 1024");
    if (!progress.is_none() && !py::isinstance<py::bool_>(progress) && !PyCallable_Check(progress.ptr()))
        throw py::type_error("progress: expected a bool or a function, found " + typeOf(progress));
    const Job job = jobOf(scene, set, folder, allowOutside);
    SessionOptions options = sessionOptions(job.loaded.renderer, limits);
    std::atomic<bool> interrupted{false};
    options.seed = seed;
    options.quiet = !progress.is(py::bool_(true));
    options.interrupted = &interrupted;
    options.afterPass = [&](const SessionResult& session) { listen(session, options, progress, interrupted); };
    options.duringPass = lookForSignals;
    const py::gil_scoped_release released;
    using tbb::global_control;
    const size_t all = global_control::active_value(global_control::max_allowed_parallelism);
    const global_control parallelism(global_control::max_allowed_parallelism, threads ? size_t(*threads) : all);
    auto session = std::make_unique<SessionResult>();
    runSession(job.loaded, *job.integrator, job.facts, job.features, {}, options, *session);
    if (session->film.passes() == 0 && session->reason == StopReason::TimedOut) {
        const py::gil_scoped_acquire gil;
        PyErr_SetString(PyExc_TimeoutError, whyNoPass(options, *session).c_str());
        throw py::error_already_set();
    }
    if (const auto black = blackImage(*job.loaded.scene, job.facts, job.features, *session)) {
        const py::gil_scoped_acquire gil;
        warn(*black);
    }
    return {job.loaded, options, std::move(session)};
}

/// What --explain says.
py::dict planOf(const py::object& scene, const py::dict& set, const Folder& folder, bool allowOutside) {
    const Job job = jobOf(scene, set, folder, allowOutside);
    py::list effects;
    for (const Feature& feature : job.features.all) {
        py::dict entry;
        entry["name"] = feature.name;
        entry["on"] = feature.on;
        entry["reason"] = feature.reason;
        entry["causes"] = feature.elements;
        entry["counters"] = feature.counters;
        effects.append(entry);
    }
    py::dict plan;
    plan["integrator"] = job.loaded.integratorType;
    py::dict sampling;
    sampling["paths"] = job.features.sampling.paths;
    sampling["vertices"] = job.features.sampling.vertices;
    sampling["ends"] = job.features.sampling.ends;
    plan["sampling"] = sampling;
    plan["effects"] = effects;
    plan["lacks"] = job.features.limitations;
    py::list defaults;
    for (const DefaultTaken& taken : defaultsTaken(job, plugins().registry)) {
        py::dict entry;
        entry["field"] = taken.field;
        entry["value"] = taken.value;
        entry["meaning"] = taken.meaning;
        defaults.append(entry);
    }
    plan["defaults"] = defaults;
    return plan;
}

/// What --describe says.
py::list describe(const std::string& type) {
    py::list types;
    for (const DescribedKind& kind : selectDescriptions(describeAll(plugins().registry), type))
        for (const auto& description : kind.types) {
            py::list fields;
            for (const Field& field : description->fields) {
                py::dict entry;
                entry["name"] = field.name;
                entry["accepted"] = field.accepted;
                entry["default"] = field.fallback;
                entry["unit"] = field.unit;
                entry["meaning"] = field.meaning;
                fields.append(entry);
            }
            py::dict entry;
            entry["name"] = description->name;
            entry["kind"] = kind.kind;
            entry["note"] = description->note;
            entry["fields"] = fields;
            types.append(entry);
        }
    return types;
}

/// Exceptions of Python for ours: an InputError lists every problem as (file, path, message).
void declareErrors(py::module_& module) {
    static PyObject* inputError = nullptr; // live as long as the module, which Python never unloads
    static PyObject* usageError = nullptr;
    inputError = PyErr_NewExceptionWithDoc("darts_tungsten.InputError",
                                           "A mistake in a scene or file; `problems` lists all of them as (file, path, "
                                           "message), `warnings` what would have been warned about.",
                                           PyExc_ValueError, nullptr);
    usageError = PyErr_NewException("darts_tungsten.UsageError", PyExc_ValueError, nullptr);
    module.attr("InputError") = py::handle(inputError);
    module.attr("UsageError") = py::handle(usageError);
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const InputError& error) {
            const auto listed = [](const std::vector<Problem>& problems) {
                py::list list;
                for (const Problem& problem : problems)
                    list.append(py::make_tuple(problem.file, problem.path, problem.message));
                return list;
            };
            const py::object raised = py::handle(inputError)(error.what());
            raised.attr("problems") = listed(error.problems());
            raised.attr("warnings") = listed(error.warnings());
            PyErr_SetObject(inputError, raised.ptr());
        } catch (const UsageError& error) {
            PyErr_SetString(usageError, error.what());
        }
    });
}

constexpr const char* RenderText =
    "Renders a scene, the name of a file or a dict, and writes nothing.\n\n"
    "set: {\"media.fog.sigma_s\": 0.3} as --set. It stops after `seconds`, `passes`, `samples` per pixel "
    "(default:\n"
    "the scene's spp) or when the relative error is at most `target_error`, whichever comes first. `progress`: True "
    "for the\n"
    "command's bar, or a function that is called with a dict after each pass and may return False to stop. `folder`: "
    "where\n"
    "the scene's files are, if not beside it. A pass in progress is broken off when the seconds are over "
    "(TimeoutError: not "
    "one has\n"
    "ended) and at Ctrl-C.";

} // namespace

void declare(py::module_& module) {
    module.doc() = "A time-of-flight renderer; see docs/python.md.";
    module.attr("__version__") = TUNGSTEN_VERSION;
    declareErrors(module);
    declareResult(module);
    using namespace py::literals;
    const auto renderWith = [](const py::object& scene, const py::dict& set, std::optional<double> seconds,
                               std::optional<int64_t> passes, std::optional<int64_t> samples,
                               std::optional<double> targetError, uint64_t seed, std::optional<int> threads,
                               const py::object& progress, const Folder& folder, bool allowOutside) {
        return render(scene, set, {seconds, passes, samples, targetError}, seed, threads, progress, folder,
                      allowOutside);
    };
    module.def("render", renderWith, RenderText, "scene"_a, py::kw_only(), "set"_a = py::dict(),
               "seconds"_a = py::none(), "passes"_a = py::none(), "samples"_a = py::none(),
               "target_error"_a = py::none(), "seed"_a = SessionOptions().seed, "threads"_a = py::none(),
               "progress"_a = py::none(), "folder"_a = py::none(), "allow_outside"_a = false);
    module.def("plan", planOf, "Which effects a scene calls for, and why (--explain).", "scene"_a, py::kw_only(),
               "set"_a = py::dict(), "folder"_a = py::none(), "allow_outside"_a = false);
    module.def("describe", describe, "The fields of a type, kind or block, or of all (--describe).", "type"_a = "");
}

} // namespace tungsten::python

PYBIND11_MODULE(_native, module) {
    tungsten::python::declare(module);
}
