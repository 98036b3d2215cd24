// Stanford .ply: ASCII or binary of either endianness, any elements and properties in any order.

#include "tungsten/core/Errors.h"
#include "tungsten/geometry/MeshFile.h"
#include "tungsten/geometry/TextCursor.h"

#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <string>

namespace tungsten {

namespace {

enum class Encoding { Ascii, LittleEndian, BigEndian };

struct ScalarType {
    enum class Kind { Signed, Unsigned, Real } kind;
    size_t bytes;
};

const std::map<std::string_view, ScalarType>& scalarTypes() {
    using Kind = ScalarType::Kind;
    static const std::map<std::string_view, ScalarType> types{
        {"char", {Kind::Signed, 1}},     {"int8", {Kind::Signed, 1}},     {"uchar", {Kind::Unsigned, 1}},
        {"uint8", {Kind::Unsigned, 1}},  {"short", {Kind::Signed, 2}},    {"int16", {Kind::Signed, 2}},
        {"ushort", {Kind::Unsigned, 2}}, {"uint16", {Kind::Unsigned, 2}}, {"int", {Kind::Signed, 4}},
        {"int32", {Kind::Signed, 4}},    {"uint", {Kind::Unsigned, 4}},   {"uint32", {Kind::Unsigned, 4}},
        {"float", {Kind::Real, 4}},      {"float32", {Kind::Real, 4}},    {"double", {Kind::Real, 8}},
        {"float64", {Kind::Real, 8}}};
    return types;
}

struct Property {
    std::string name;
    ScalarType type{};
    bool isList = false;
    ScalarType countType{}; ///< of lists
};

struct Element {
    std::string name;
    uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Encoding encoding = Encoding::Ascii;
    std::vector<Element> elements;
    size_t bytes = 0; ///< where the body starts
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
    throw InputError(file.string(), message);
}

ScalarType typeNamed(std::string_view name, const std::filesystem::path& file) {
    const auto type = scalarTypes().find(name);
    if (type == scalarTypes().end()) fail(file, "unknown property type '" + std::string(name.substr(0, 32)) + "'");
    return type->second;
}

Encoding encodingNamed(std::string_view name, const std::filesystem::path& file) {
    if (name == "ascii") return Encoding::Ascii;
    if (name == "binary_little_endian") return Encoding::LittleEndian;
    if (name == "binary_big_endian") return Encoding::BigEndian;
    fail(file, "unknown format '" + std::string(name.substr(0, 32)) +
                   "'; accepted: ascii, binary_little_endian or binary_big_endian");
}

Property readProperty(TextCursor& words, const std::filesystem::path& file) {
    Property property;
    std::string_view type = words.nextWord();
    if (type == "list") {
        property.isList = true;
        property.countType = typeNamed(words.nextWord(), file);
        type = words.nextWord();
    }
    property.type = typeNamed(type, file);
    property.name = words.nextWord();
    return property;
}

void requirePly(std::string_view text, const std::filesystem::path& file) {
    if (TextCursor(TextCursor(utf8Of(text, file)).nextLine()).nextWord() != "ply")
        fail(file, "not a PLY file (it must start with 'ply')");
}

Header readHeader(std::string_view text, const std::filesystem::path& file) {
    Header header;
    TextCursor lines(text);
    (void)lines.nextLine(); // "ply"
    bool hasFormat = false;
    while (!lines.atEnd()) {
        TextCursor words(lines.nextLine());
        const std::string_view keyword = words.nextWord();
        if (keyword == "end_header") {
            if (!hasFormat) fail(file, "the header has no format line");
            header.bytes = lines.position();
            return header;
        }
        if (keyword == "format") {
            header.encoding = encodingNamed(words.nextWord(), file);
            hasFormat = true;
        } else if (keyword == "element") {
            const std::string_view name = words.nextWord();
            const auto count = parseNumber<uint64_t>(words.nextWord());
            if (!count) fail(file, "element '" + std::string(name.substr(0, 32)) + "' has no valid count");
            header.elements.push_back({std::string(name), *count, {}});
        } else if (keyword == "property") {
            if (header.elements.empty()) fail(file, "a property comes before the first element");
            header.elements.back().properties.push_back(readProperty(words, file));
        }
    }
    fail(file, "the header has no end (end_header)");
}

/// The values of the body, one after the other.
class BodyReader {
  public:
    BodyReader(std::string_view body, Encoding encoding, const std::filesystem::path& file, const LoadWatch& watch)
        : body_(body), text_(body), encoding_(encoding), file_(file), watch_(watch) {}

    double next(const ScalarType& type) {
        if (encoding_ == Encoding::Ascii) {
            const std::string_view word = text_.nextWord();
            if (word.empty()) fail(file_, "ends before all elements are read");
            const auto number = parseNumber<double>(word);
            if (!number) fail(file_, "expected a number, found '" + std::string(word.substr(0, 32)) + "'");
            return *number;
        }
        if (remaining() < type.bytes) fail(file_, "ends before all elements are read");
        const bool swapped = (encoding_ == Encoding::BigEndian) != (std::endian::native == std::endian::big);
        std::array<unsigned char, 8> raw{};
        for (size_t i = 0; i < raw.size() && i < type.bytes; ++i)
            raw[i] = static_cast<unsigned char>(body_[position_ + (swapped ? type.bytes - 1 - i : i)]);
        position_ += type.bytes;
        return decode(raw.data(), type);
    }

    /// Before each record of an element.
    void startRecord(uint64_t index) const { watch_.pollEvery(index); }

    /// The length of a list, checked against the bytes that are left.
    size_t nextCount(const Property& list) {
        const double count = next(list.countType);
        const auto most = remaining() / smallestSize(list.type);
        if (!(count >= 0.0) || count > double(most) || count != std::floor(count))
            fail(file_, "a list '" + list.name + "' claims more values than the file holds");
        return size_t(count);
    }

    void skip(const Property& property) {
        const size_t values = property.isList ? nextCount(property) : 1;
        for (size_t k = 0; k < values; ++k) next(property.type);
    }

    /// Throws unless `element.count` records can possibly fit into the rest of the file.
    void requireRoomFor(const Element& element) const {
        size_t smallest = 0;
        for (const Property& property : element.properties)
            smallest += smallestSize(property.isList ? property.countType : property.type);
        if (smallest > 0 && element.count > remaining() / smallest)
            fail(file_, "claims " + std::to_string(element.count) + " elements '" + element.name +
                            "', more than the file can hold");
    }

  private:
    [[nodiscard]] size_t remaining() const {
        // The last number of a text needs no blank behind it.
        return encoding_ == Encoding::Ascii ? body_.size() + 1 - text_.position() : body_.size() - position_;
    }
    [[nodiscard]] size_t smallestSize(const ScalarType& type) const {
        return encoding_ == Encoding::Ascii ? 2 : type.bytes;
    }

    template <typename Value>
    static double as(const unsigned char* raw) {
        Value value;
        std::memcpy(&value, raw, sizeof(Value));
        return double(value);
    }
    static double decode(const unsigned char* raw, const ScalarType& type) {
        switch (type.kind) {
        case ScalarType::Kind::Real:
            return type.bytes == 4 ? as<float>(raw) : as<double>(raw);
        case ScalarType::Kind::Signed:
            return type.bytes == 1 ? as<int8_t>(raw) : type.bytes == 2 ? as<int16_t>(raw) : as<int32_t>(raw);
        case ScalarType::Kind::Unsigned:
            break;
        }
        return type.bytes == 1 ? as<uint8_t>(raw) : type.bytes == 2 ? as<uint16_t>(raw) : as<uint32_t>(raw);
    }

    std::string_view body_;
    TextCursor text_;
    size_t position_ = 0;
    Encoding encoding_;
    std::filesystem::path file_;
    const LoadWatch& watch_;
};

/// Which vertex quantity a property is: 0-2 position, 3-5 normal, 6-7 uv, 8 none of them.
constexpr size_t Quantities = 8;
size_t quantityOf(const std::string& name) {
    static const std::map<std::string, size_t> quantities{
        {"x", 0}, {"y", 1}, {"z", 2}, {"nx", 3},        {"ny", 4},        {"nz", 5},        {"u", 6},
        {"v", 7}, {"s", 6}, {"t", 7}, {"texture_u", 6}, {"texture_v", 7}, {"texture_s", 6}, {"texture_t", 7}};
    const auto found = quantities.find(name);
    return found == quantities.end() ? Quantities : found->second;
}

void readVertices(BodyReader& body, const Element& element, TriangleMesh& mesh, const std::filesystem::path& file) {
    std::array<bool, Quantities + 1> present{};
    std::vector<size_t> quantities;
    for (const Property& property : element.properties) {
        quantities.push_back(property.isList ? Quantities : quantityOf(property.name));
        present[quantities.back()] = true;
    }
    if (!(present[0] && present[1] && present[2])) fail(file, "its vertices have no x, y and z");
    if (element.count > UINT32_MAX) fail(file, "has more than 2^32 vertices");
    const bool hasNormals = present[3] && present[4] && present[5], hasUvs = present[6] && present[7];
    mesh.positions.reserve(element.count + 1); // see padPositions
    if (hasNormals) mesh.normals.reserve(element.count);
    if (hasUvs) mesh.uvs.reserve(element.count);
    std::array<float, Quantities + 1> value{};
    for (uint64_t i = 0; i < element.count; ++i) {
        body.startRecord(i);
        for (size_t p = 0; p < quantities.size(); ++p) {
            const Property& property = element.properties[p];
            const size_t values = property.isList ? body.nextCount(property) : 1;
            for (size_t k = 0; k < values; ++k) value[quantities[p]] = float(body.next(property.type));
        }
        mesh.positions.push_back({value[0], value[1], value[2]});
        if (hasNormals) mesh.normals.push_back({value[3], value[4], value[5]});
        if (hasUvs) mesh.uvs.push_back({value[6], value[7]});
    }
}

/// One polygon as a fan; polygons of fewer than three corners have no area and are left out.
void readPolygon(BodyReader& body, const Property& list, TriangleMesh& mesh, const std::filesystem::path& file) {
    const size_t corners = body.nextCount(list);
    uint32_t first = 0, previous = 0;
    for (size_t k = 0; k < corners; ++k) {
        const double index = body.next(list.type);
        if (!(index >= 0.0) || index > double(UINT32_MAX) || index != std::floor(index))
            fail(file, "a face has an invalid vertex index");
        const auto vertex = uint32_t(index);
        if (k == 0) first = vertex;
        if (k >= 2) mesh.triangles.push_back({{first, previous, vertex}});
        previous = vertex;
    }
}

void readFaces(BodyReader& body, const Element& element, TriangleMesh& mesh, const std::filesystem::path& file) {
    for (uint64_t i = 0; i < element.count; ++i) {
        body.startRecord(i);
        for (const Property& property : element.properties) {
            if (property.isList && (property.name == "vertex_indices" || property.name == "vertex_index"))
                readPolygon(body, property, mesh, file);
            else
                body.skip(property);
        }
    }
}

void skipElement(BodyReader& body, const Element& element) {
    for (uint64_t i = 0; i < element.count; ++i) {
        body.startRecord(i);
        for (const Property& property : element.properties) body.skip(property);
    }
}

} // namespace

TriangleMesh loadPly(const std::filesystem::path& file, const LoadWatch& watch) {
    const std::vector<char> bytes =
        readFileBytes(file, watch, [&](std::string_view start, uint64_t) { requirePly(start, file); });
    const std::string_view text = utf8Of(bytes, file);
    const Header header = readHeader(text, file);
    BodyReader body(text.substr(header.bytes), header.encoding, file, watch);
    TriangleMesh mesh;
    bool hasVertices = false;
    for (const Element& element : header.elements) {
        if (element.properties.empty()) continue;
        body.requireRoomFor(element);
        if (element.name == "vertex" && !hasVertices) {
            readVertices(body, element, mesh, file);
            hasVertices = true;
        } else if (element.name == "face") {
            readFaces(body, element, mesh, file);
        } else if (element.name == "tristrips") {
            fail(file, "triangle strips are not supported; accepted: an element 'face'");
        } else {
            skipElement(body, element);
        }
    }
    finishMesh(mesh, file);
    return mesh;
}

} // namespace tungsten
