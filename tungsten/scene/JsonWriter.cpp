#include "tungsten/scene/JsonWriter.h"

#include <rapidjson/prettywriter.h>
#include <rapidjson/stringbuffer.h>

#include <cmath>

namespace tungsten {

struct JsonWriter::Implementation {
    rapidjson::StringBuffer buffer;
    rapidjson::PrettyWriter<rapidjson::StringBuffer> writer{buffer};
};

JsonWriter::JsonWriter() : implementation_(std::make_unique<Implementation>()) {
    implementation_->writer.SetIndent(' ', 2);
    implementation_->writer.StartObject();
}
JsonWriter::~JsonWriter() = default;

void JsonWriter::field(const std::string& name, const std::string& value) {
    implementation_->writer.Key(name.c_str());
    implementation_->writer.String(value.c_str());
}

void JsonWriter::field(const std::string& name, double value) {
    implementation_->writer.Key(name.c_str());
    if (std::isfinite(value))
        implementation_->writer.Double(value);
    else
        implementation_->writer.Null();
}

void JsonWriter::field(const std::string& name, uint64_t value) {
    implementation_->writer.Key(name.c_str());
    implementation_->writer.Uint64(value);
}

void JsonWriter::beginObject(const std::string& name) {
    implementation_->writer.Key(name.c_str());
    implementation_->writer.StartObject();
}

void JsonWriter::endObject() {
    implementation_->writer.EndObject();
}

std::string JsonWriter::finish() {
    implementation_->writer.EndObject();
    return std::string(implementation_->buffer.GetString()) + "\n";
}

} // namespace tungsten
