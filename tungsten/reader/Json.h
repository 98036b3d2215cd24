#pragma once
// The JSON library behind ObjectReader; included only by the files of this folder that parse.

#include "tungsten/reader/ObjectReader.h"

#include "tungsten/core/LoadWatch.h"

#include <rapidjson/document.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tungsten {

/// A node is the address of a JSON value that lives in the reader's document; the type itself is never defined.
inline const rapidjson::Value& valueOf(const ObjectReader::Node* node) {
    return *reinterpret_cast<const rapidjson::Value*>(node);
}
inline const ObjectReader::Node* nodeOf(const rapidjson::Value& value) {
    return reinterpret_cast<const ObjectReader::Node*>(&value);
}

/// Parses the format's grammar: JSON with comments, trailing commas, NaN and Inf, an optional byte-order mark. Throws
/// InputError with line and column, in the name of `file`.
std::shared_ptr<rapidjson::Document> parseJson(const std::string& text, const std::string& file);
std::shared_ptr<rapidjson::Document> parseJsonFile(const std::filesystem::path& file, const LoadWatch& watch = {});

/// Applies "path.to.field=value" to the document: array elements by index, by `name`, or all of them by `*`. An
/// object in the place of one that has a name keeps it unless it has one of its own. The value is JSON, or else a
/// string. Throws UsageError, naming the nearest member, when the path leads nowhere.
void applyOverride(rapidjson::Document& document, const std::string& assignment);

} // namespace tungsten
