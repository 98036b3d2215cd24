#pragma once
// Writing JSON without showing the library that does it.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tungsten {

/// Builds one JSON object, nested objects and arrays of objects included, with two-space indentation. Numbers that are
/// not finite become null.
class JsonWriter {
  public:
    JsonWriter();
    ~JsonWriter();
    JsonWriter(const JsonWriter&) = delete;
    JsonWriter& operator=(const JsonWriter&) = delete;

    void field(const std::string& name, const std::string& value);
    void field(const std::string& name, const char* value) { field(name, std::string(value)); }
    void field(const std::string& name, double value);
    void field(const std::string& name, uint64_t value);
    void field(const std::string& name, bool value);
    void field(const std::string& name, const std::vector<double>& values);
    void field(const std::string& name, const std::vector<std::string>& values);
    /// A value that is JSON already.
    void jsonField(const std::string& name, const std::string& json);
    void beginObject(const std::string& name);
    void endObject();
    /// Objects follow, without names.
    void beginArray(const std::string& name);
    void beginObject();
    void endArray();
    /// Closes the outer object. Call once.
    [[nodiscard]] std::string finish();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Whether the text is one JSON object, as jsonField() needs it.
bool isJsonObject(const std::string& text);

} // namespace tungsten
