#include "tungsten/scene/JsonWriter.h"

#include <rapidjson/memorystream.h>
#include <rapidjson/prettywriter.h>
#include <rapidjson/reader.h>
#include <rapidjson/stringbuffer.h>

#include <algorithm>
#include <cmath>

namespace tungsten {

namespace {

/// Length of the UTF-8 sequence at `at`, or 0 if there is none.
size_t sequenceLength(const std::string& text, size_t at) {
    const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(at);
    const size_t length = first < 0x80   ? 1
                          : first < 0xC2 ? 0
                          : first < 0xE0 ? 2
                          : first < 0xF0 ? 3
                          : first < 0xF5 ? 4
                                         : 0;
    for (size_t i = 1; i < length; ++i)
        if ((byte(at + i) & 0xC0) != 0x80) return 0;
    // Longer than needed, surrogates, beyond the last character.
    const unsigned second = byte(at + 1);
    const bool wrong = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
                       (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
    return wrong ? 0 : length;
}

/// Names of files, and a scene's own, may be any bytes; JSON is UTF-8. What is not becomes the replacement character.
std::string validUtf8(const std::string& text) {
    std::string valid;
    for (size_t at = 0; at < text.size();) {
        const size_t length = sequenceLength(text, at);
        valid += length > 0 ? text.substr(at, length) : "\xEF\xBF\xBD";
        at += std::max<size_t>(length, 1);
    }
    return valid;
}

} // namespace

struct JsonWriter::Implementation {
    rapidjson::StringBuffer buffer;
    rapidjson::PrettyWriter<rapidjson::StringBuffer> writer{buffer};

    void add(double value) { std::isfinite(value) ? writer.Double(value) : writer.Null(); }
    void add(const std::string& value) {
        const std::string valid = validUtf8(value);
        writer.String(valid.data(), rapidjson::SizeType(valid.size()));
    }
};

JsonWriter::JsonWriter() : implementation_(std::make_unique<Implementation>()) {
    implementation_->writer.SetIndent(' ', 2);
    implementation_->writer.StartObject();
}
JsonWriter::~JsonWriter() = default;

void JsonWriter::field(const std::string& name, const std::string& value) {
    implementation_->writer.Key(name.c_str());
    implementation_->add(value);
}

void JsonWriter::field(const std::string& name, double value) {
    implementation_->writer.Key(name.c_str());
    implementation_->add(value);
}

void JsonWriter::field(const std::string& name, bool value) {
    implementation_->writer.Key(name.c_str());
    implementation_->writer.Bool(value);
}

void JsonWriter::field(const std::string& name, const std::vector<double>& values) {
    beginArray(name);
    for (const double value : values) implementation_->add(value);
    endArray();
}

void JsonWriter::field(const std::string& name, const std::vector<std::string>& values) {
    beginArray(name);
    for (const std::string& value : values) implementation_->add(value);
    endArray();
}

void JsonWriter::jsonField(const std::string& name, const std::string& json) {
    implementation_->writer.Key(name.c_str());
    const std::string valid = validUtf8(json);
    implementation_->writer.RawValue(valid.data(), valid.size(), rapidjson::kObjectType);
}

void JsonWriter::field(const std::string& name, uint64_t value) {
    implementation_->writer.Key(name.c_str());
    implementation_->writer.Uint64(value);
}

void JsonWriter::beginObject(const std::string& name) {
    implementation_->writer.Key(name.c_str());
    implementation_->writer.StartObject();
}

void JsonWriter::beginArray(const std::string& name) {
    implementation_->writer.Key(name.c_str());
    implementation_->writer.StartArray();
}

void JsonWriter::beginObject() {
    implementation_->writer.StartObject();
}

void JsonWriter::endArray() {
    implementation_->writer.EndArray();
}

void JsonWriter::endObject() {
    implementation_->writer.EndObject();
}

std::string JsonWriter::finish() {
    implementation_->writer.EndObject();
    return std::string(implementation_->buffer.GetString()) + "\n";
}

bool isJsonObject(const std::string& text) {
    constexpr unsigned Grammar = rapidjson::kParseNanAndInfFlag | rapidjson::kParseIterativeFlag;
    rapidjson::MemoryStream bytes(text.data(), text.size());
    rapidjson::Reader reader;
    rapidjson::BaseReaderHandler<> nothing;
    const bool valid = !reader.Parse<Grammar>(bytes, nothing).IsError();
    return valid && text.find('\0') == std::string::npos && text.find_first_not_of(" \t\r\n") == text.find('{');
}

} // namespace tungsten
