// Wavefront .obj: the whole file becomes one mesh.

#include "tungsten/core/Errors.h"
#include "tungsten/geometry/MeshFile.h"
#include "tungsten/geometry/TextCursor.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <unordered_map>

namespace tungsten {

namespace {

const Vec3f MissingNormal(0.0f, 1.0f, 0.0f);

/// Zero-based indices of one corner; -1 where the file gives none.
struct Corner {
    int32_t position = -1, uv = -1, normal = -1;
    bool operator==(const Corner&) const = default;
};

struct CornerHash {
    size_t operator()(const Corner& c) const {
        uint64_t hash = uint32_t(c.position);
        hash = hash * 0x9E3779B97F4A7C15u + uint32_t(c.uv);
        hash = hash * 0x9E3779B97F4A7C15u + uint32_t(c.normal);
        return size_t(hash ^ (hash >> 31));
    }
};

class ObjReader {
  public:
    ObjReader(const std::filesystem::path& file, const LoadWatch& watch) : file_(file), watch_(watch) {}

    TriangleMesh read() {
        std::vector<char> bytes = readFileBytes(
            file_, watch_, [&](std::string_view start, uint64_t size) { requireText(file_, start, size); });
        joinContinuedLines(bytes);
        TextCursor text(utf8Of(bytes, file_));
        while (!text.atEnd()) {
            watch_.pollEvery(++line_);
            readLine(text.nextLine());
        }
        if (uvs_.empty()) mesh_.uvs.clear();
        finishMesh(mesh_, file_);
        return std::move(mesh_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(file_.string(), "line " + std::to_string(line_) + ": " + message);
    }

    static void joinContinuedLines(std::vector<char>& bytes) {
        for (size_t i = 0; i + 1 < bytes.size(); ++i) {
            if (bytes[i] != '\\' || (bytes[i + 1] != '\n' && bytes[i + 1] != '\r')) continue;
            if (bytes[i + 1] == '\r' && i + 2 < bytes.size() && bytes[i + 2] == '\n') bytes[i + 2] = ' ';
            bytes[i] = bytes[i + 1] = ' ';
        }
    }

    void readLine(std::string_view line) {
        TextCursor words(line.substr(0, line.find('#')));
        std::string keyword(words.nextWord());
        for (char& c : keyword) c = char(std::tolower(static_cast<unsigned char>(c)));
        if (keyword == "v") {
            positions_.push_back(readVector(words, 3));
        } else if (keyword == "vn") {
            normals_.push_back(readVector(words, 3));
        } else if (keyword == "vt") {
            const Vec3f uv = readVector(words, 1);
            uvs_.push_back({uv.x, uv.y});
        } else if (keyword == "f") {
            readFace(words);
        }
    }

    /// Up to three numbers, of which the first `required` must be there.
    Vec3f readVector(TextCursor& words, int required) const {
        Vec3f value(0.0f);
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = words.nextWord();
            if (word.empty() && i >= required) break;
            const auto number = parseNumber<double>(word);
            if (!number) fail("expected a number, found '" + std::string(word.substr(0, 32)) + "'");
            value[i] = float(*number);
        }
        return value;
    }

    /// One-based or negative (counted from the end) index into `count` elements, as zero-based.
    int32_t readIndex(std::string_view word, size_t count, const char* what) const {
        const auto index = parseNumber<int64_t>(word);
        if (!index)
            fail("expected the index of a " + std::string(what) + ", found '" + std::string(word.substr(0, 32)) + "'");
        const int64_t zeroBased = *index < 0 ? int64_t(count) + *index : *index - 1;
        if (zeroBased < 0 || zeroBased >= int64_t(count) || zeroBased > INT32_MAX)
            fail(std::string(what) + " " + std::string(word.substr(0, 32)) +
                 " is out of range: " + std::to_string(count) + " defined so far");
        return int32_t(zeroBased);
    }

    Corner readCorner(std::string_view word) const {
        Corner corner;
        const size_t first = word.find('/');
        corner.position = readIndex(word.substr(0, first), positions_.size(), "position");
        if (first == std::string_view::npos) return corner;
        word.remove_prefix(first + 1);
        const size_t second = word.find('/');
        if (const auto uv = word.substr(0, second); !uv.empty())
            corner.uv = readIndex(uv, uvs_.size(), "texture coordinate");
        if (second == std::string_view::npos) return corner;
        if (const auto normal = word.substr(second + 1); !normal.empty())
            corner.normal = readIndex(normal, normals_.size(), "normal");
        return corner;
    }

    uint32_t vertexOf(const Corner& corner) {
        const auto [entry, isNew] = vertices_.try_emplace(corner, uint32_t(mesh_.positions.size()));
        if (isNew) {
            mesh_.positions.push_back(positions_[size_t(corner.position)]);
            mesh_.uvs.push_back(corner.uv < 0 ? Vec2f(0.0f) : uvs_[size_t(corner.uv)]);
            mesh_.normals.push_back(corner.normal < 0 ? MissingNormal : normals_[size_t(corner.normal)]);
        }
        return entry->second;
    }

    void readFace(TextCursor& words) {
        uint32_t first = 0, previous = 0;
        for (int count = 0;; ++count) {
            const std::string_view word = words.nextWord();
            if (word.empty()) return;
            const uint32_t vertex = vertexOf(readCorner(word));
            if (count == 0) first = vertex;
            if (count >= 2) mesh_.triangles.push_back({{first, previous, vertex}});
            previous = vertex;
        }
    }

    std::filesystem::path file_;
    const LoadWatch& watch_;
    size_t line_ = 0;
    std::vector<Vec3f> positions_, normals_;
    std::vector<Vec2f> uvs_;
    std::unordered_map<Corner, uint32_t, CornerHash> vertices_;
    TriangleMesh mesh_;
};

} // namespace

TriangleMesh loadObj(const std::filesystem::path& file, const LoadWatch& watch) {
    return ObjReader(file, watch).read();
}

} // namespace tungsten
