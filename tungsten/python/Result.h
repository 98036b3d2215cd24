#pragma once
// A render as Python sees it.

#include "tungsten/session/Job.h"
#include "tungsten/session/Session.h"

#include <pybind11/numpy.h>

namespace tungsten::python {

/// What a render left: the film in output units, and what is known about it. Arrays that Python gets are views of it.
class Result {
  public:
    /// Images are made once, here.
    Result(LoadedScene loaded, const SessionOptions& options, std::unique_ptr<const SessionResult> session);

    [[nodiscard]] const SessionResult& session() const { return *session_; }
    [[nodiscard]] const Scene& scene() const { return *loaded_.scene; }
    [[nodiscard]] const std::string& metadata() const { return metadata_; }
    /// Writes an image of output_use::Linear or Shown, with what goes beside it. Returns the files' names.
    [[nodiscard]] std::vector<std::string> write(const std::filesystem::path& file) const;

    /// Read-only views (frames, height, width, 3) that keep `self` alive.
    static pybind11::array mean(const pybind11::object& self);
    static pybind11::array standardError(const pybind11::object& self);
    /// The same of the means of batches; None without them.
    static pybind11::object batchMeans(const pybind11::object& self);

  private:
    LoadedScene loaded_;
    std::unique_ptr<const SessionResult> session_;
    std::string metadata_;
    std::vector<float> mean_, standardError_, batchMeans_;
};

void declareResult(pybind11::module_& module);

/// Per pixel: a whole number, or a fraction where passes were cut.
pybind11::object samplesOf(const SessionResult& session);

} // namespace tungsten::python
