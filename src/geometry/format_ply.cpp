// PLY, text and binary of both byte orders. A header declares elements and their properties; the
// vertex positions, the corner lists of faces (or the strips of a "tristrips" element) and one
// integer property of faces that can be a label are taken, everything else is walked over.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "geometry/mesh_curves.h"
#include "geometry/mesh_formats.h"
#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"
#include "geometry/vertex_values.h"

namespace fcn {

namespace {

enum class Type { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

struct TypeName {
    std::string_view old_name, new_name;
    Type type;
    std::size_t size;
};
constexpr std::array kTypes{
    TypeName{"char", "int8", Type::Int8, 1},        TypeName{"uchar", "uint8", Type::UInt8, 1},
    TypeName{"short", "int16", Type::Int16, 2},     TypeName{"ushort", "uint16", Type::UInt16, 2},
    TypeName{"int", "int32", Type::Int32, 4},       TypeName{"uint", "uint32", Type::UInt32, 4},
    TypeName{"float", "float32", Type::Float32, 4}, TypeName{"double", "float64", Type::Float64, 8},
};

std::size_t size_of(Type type) { return kTypes[static_cast<std::size_t>(type)].size; }
bool is_floating(Type type) { return type == Type::Float32 || type == Type::Float64; }

struct Property {
    std::string name;
    Type type = Type::Float32;
    bool is_list = false;
    Type count_type = Type::UInt8;
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

/// Face properties that are taken for a label, the first found in this order.
constexpr std::array kLabelNames{
    "label",       "labels",  "region",     "region_id", "material", "material_index",
    "material_id", "segment", "segment_id", "group",     "group_id", "patch",
    "patch_id",    "part",    "part_id",    "ref",       "chart",    "object",
};

/// The values of a PLY body, one after the other, whichever the encoding.
class PlyValues {
public:
    enum class Encoding { Text, Little, Big };

    PlyValues(TextCursor& in, Encoding encoding)
        : in_(in), encoding_(encoding), bytes_(in.remaining_text()) {}

    double number(Type type, std::string_view what) {
        if (encoding_ == Encoding::Text) return in_.number(what);
        const double value = binary(type);
        if (!std::isfinite(value)) fail(std::string(what) + " is not finite");
        return value;
    }

    std::int64_t integer(Type type, std::string_view what) {
        if (encoding_ == Encoding::Text) return in_.integer(what);
        return static_cast<std::int64_t>(binary(type));
    }

    void skip(Type type, std::size_t count) {
        if (encoding_ == Encoding::Text) {
            for (std::size_t i = 0; i < count; ++i) {
                if (in_.token().empty()) fail("the file is truncated");
            }
            return;
        }
        if (count > (bytes_.size() - offset_) / size_of(type)) fail("the file is truncated");
        offset_ += count * size_of(type);
    }

    /// Bytes that are left for `count` items that take at least `bytes_each` in binary.
    void check_room(std::size_t count, std::size_t bytes_each, const std::string& what) const {
        const bool is_text = encoding_ == Encoding::Text;
        const std::size_t left = is_text ? in_.remaining() : bytes_.size() - offset_;
        // In a text an item is at least a digit and a separator; the last may lack the latter.
        const std::size_t least = is_text ? 2 : std::max<std::size_t>(bytes_each, 1);
        if (count > left / least + 1 || (!is_text && count > left / least)) {
            fail(std::to_string(count) + " " + what + " are announced, but only " +
                 std::to_string(left) + " bytes follow: the file is truncated or damaged");
        }
    }

    [[noreturn]] void fail(const std::string& message) const {
        if (encoding_ == Encoding::Text) in_.fail(message);
        in_.fail("byte " + std::to_string(offset_) + " behind the header: " + message);
    }

private:
    double binary(Type type) {
        switch (type) {
            case Type::Int8:
                return take<std::int8_t>();
            case Type::UInt8:
                return take<std::uint8_t>();
            case Type::Int16:
                return take<std::int16_t>();
            case Type::UInt16:
                return take<std::uint16_t>();
            case Type::Int32:
                return take<std::int32_t>();
            case Type::UInt32:
                return take<std::uint32_t>();
            case Type::Float32:
                return take<float>();
            case Type::Float64:
                return take<double>();
        }
        return 0;
    }

    template <typename Value>
    Value take() {
        std::array<char, sizeof(Value)> raw;
        if (bytes_.size() - offset_ < sizeof(Value)) fail("the file is truncated");
        std::memcpy(raw.data(), bytes_.data() + offset_, sizeof(Value));
        offset_ += sizeof(Value);
        const bool is_big = encoding_ == Encoding::Big;
        if (is_big != (std::endian::native == std::endian::big)) {
            std::reverse(raw.begin(), raw.end());
        }
        return std::bit_cast<Value>(raw);
    }

    TextCursor& in_;
    Encoding encoding_;
    std::string_view bytes_;
    std::size_t offset_ = 0;
};

struct Header {
    PlyValues::Encoding encoding = PlyValues::Encoding::Text;
    std::vector<Element> elements;
};

Type read_type(TextCursor& in) {
    const std::string_view word = in.token_on_line();
    for (const TypeName& type : kTypes) {
        if (word == type.old_name || word == type.new_name) return type.type;
    }
    in.fail("unknown property type " + shown(word));
}

Property read_property(TextCursor& in) {
    Property property;
    TextCursor ahead = in;
    if (ahead.token_on_line() == "list") {
        in = ahead;
        property.is_list = true;
        property.count_type = read_type(in);
        if (is_floating(property.count_type)) in.fail("a list cannot have a floating count");
    }
    property.type = read_type(in);
    property.name = in.token_on_line();
    if (property.name.empty()) in.fail("a property without a name");
    return property;
}

PlyValues::Encoding read_encoding(TextCursor& in) {
    const std::string_view word = in.token_on_line();
    if (word == "ascii") return PlyValues::Encoding::Text;
    if (word == "binary_little_endian") return PlyValues::Encoding::Little;
    if (word == "binary_big_endian") return PlyValues::Encoding::Big;
    in.fail("unknown format " + shown(word));
}

Header read_header(TextCursor& in) {
    Header header;
    in.expect("ply");
    bool has_format = false;
    for (;;) {
        const std::string_view word = in.token();
        if (word.empty()) in.fail("the header has no end_header");
        if (word == "end_header") break;
        if (word == "format") {
            header.encoding = read_encoding(in);
            has_format = true;
        } else if (word == "element") {
            Element element;
            element.name = in.token_on_line();
            const std::int64_t count = in.integer_on_line("the number of elements");
            if (count < 0) in.fail("the number of elements is negative");
            element.count = static_cast<std::size_t>(count);
            header.elements.push_back(std::move(element));
        } else if (word == "property") {
            if (header.elements.empty()) in.fail("a property before the first element");
            header.elements.back().properties.push_back(read_property(in));
        } else if (word != "comment" && word != "obj_info") {
            in.fail("unknown header line " + shown(word));
        }
        in.skip_line();
    }
    if (!has_format) in.fail("the header has no format line");
    in.skip_line();
    return header;
}

class PlyReader {
public:
    PlyReader(std::string_view content, const std::string& source) : in_(content, source) {}

    /// The vertices with a property of theirs; what follows them is not read.
    VertexValues vertex_values(const std::string& property) {
        const Header header = read_header(in_);
        PlyValues values(in_, header.encoding);
        values_ = &values;
        value_name_ = property;
        for (const Element& element : header.elements) {
            read_element(element);
            if (element.name == "vertex") break;
        }
        return {std::move(soup_.points), std::move(vertex_values_)};
    }

    PolygonSoup run() {
        const Header header = read_header(in_);
        PlyValues values(in_, header.encoding);
        values_ = &values;
        for (const Element& element : header.elements) read_element(element);
        return std::move(soup_);
    }

private:
    static int index_of(const Element& element, std::initializer_list<std::string_view> names,
                        bool is_list) {
        for (std::string_view name : names) {
            for (std::size_t i = 0; i < element.properties.size(); ++i) {
                const Property& property = element.properties[i];
                if (property.name == name && property.is_list == is_list) {
                    return static_cast<int>(i);
                }
            }
        }
        return -1;
    }

    void read_element(const Element& element) {
        std::size_t bytes_each = 0;
        for (const Property& property : element.properties) {
            bytes_each += size_of(property.is_list ? property.count_type : property.type);
        }
        if (element.properties.empty()) return;
        values_->check_room(element.count, bytes_each, "items of '" + element.name + "'");
        if (element.name == "vertex") {
            read_vertices(element);
        } else if (element.name == "face" || element.name == "tristrips") {
            read_faces(element);
        } else {
            for (std::size_t i = 0; i < element.count; ++i) {
                for (const Property& property : element.properties) skip(property);
            }
        }
    }

    void skip(const Property& property) {
        std::size_t count = 1;
        if (property.is_list) count = list_size(property);
        values_->skip(property.type, count);
    }

    std::size_t list_size(const Property& property) {
        const std::int64_t count = values_->integer(property.count_type, "a list's length");
        if (count < 0) values_->fail("a list's length is negative: " + std::to_string(count));
        const auto size = static_cast<std::size_t>(count);
        values_->check_room(size, size_of(property.type), "list items");
        return size;
    }

    void read_vertices(const Element& element) {
        const std::array axes{index_of(element, {"x"}, false), index_of(element, {"y"}, false),
                              index_of(element, {"z"}, false)};
        if (std::min({axes[0], axes[1], axes[2]}) < 0) {
            values_->fail("the vertices have no x, y and z");
        }
        if (element.properties[static_cast<std::size_t>(axes[0])].type == Type::Float32) {
            soup_.precision = 0x1p-24;
        }
        const int value = value_name_.empty() ? -1 : index_of(element, {value_name_}, false);
        if (!value_name_.empty() && value < 0) {
            values_->fail("the vertices have no property '" + value_name_ + "'");
        }
        soup_.points.reserve(element.count);
        for (std::size_t i = 0; i < element.count; ++i) {
            Vec3 point = Vec3::Zero();
            for (int p = 0; p < static_cast<int>(element.properties.size()); ++p) {
                const Property& property = element.properties[static_cast<std::size_t>(p)];
                const auto axis = std::find(axes.begin(), axes.end(), p);
                if (axis == axes.end() && p != value) {
                    skip(property);
                    continue;
                }
                if (p == value) {
                    vertex_values_.push_back(values_->number(property.type, "a value"));
                } else {
                    point[axis - axes.begin()] = values_->number(property.type, "a coordinate");
                }
            }
            soup_.points.push_back(point);
        }
    }

    void read_faces(const Element& element) {
        const int list = index_of(element, {"vertex_indices", "vertex_index"}, true);
        if (list < 0) values_->fail("the faces have no list vertex_indices");
        if (is_floating(element.properties[static_cast<std::size_t>(list)].type)) {
            values_->fail("vertex indices must be integers");
        }
        int label = -1;
        for (const char* name : kLabelNames) {
            label = index_of(element, {name}, false);
            if (label >= 0 &&
                !is_floating(element.properties[static_cast<std::size_t>(label)].type)) {
                break;
            }
            label = -1;
        }
        for (std::size_t i = 0; i < element.count; ++i) {
            std::int64_t value = 0;
            const std::size_t first = soup_.polygon_count();
            for (int p = 0; p < static_cast<int>(element.properties.size()); ++p) {
                const Property& property = element.properties[static_cast<std::size_t>(p)];
                if (p == list) {
                    read_corners(property, element.name == "tristrips");
                } else if (p == label) {
                    value = values_->integer(property.type, "a face label");
                } else {
                    skip(property);
                }
            }
            if (label < 0) continue;
            if (value != static_cast<int>(value)) values_->fail("a face label is out of range");
            soup_.labels.resize(first, 0);
            soup_.labels.resize(soup_.polygon_count(), static_cast<int>(value));
        }
        if (!soup_.labels.empty()) soup_.labels.resize(soup_.polygon_count(), 0);
    }

    void read_corners(const Property& property, bool is_strip) {
        const std::size_t count = list_size(property);
        std::size_t run = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t index = values_->integer(property.type, "a vertex index");
            if (is_strip && index < 0) {
                run = 0;
                continue;
            }
            if (index < 0 || static_cast<std::size_t>(index) >= soup_.points.size()) {
                values_->fail("vertex index " + std::to_string(index) + " is out of range, " +
                              std::to_string(soup_.points.size()) + " vertices so far");
            }
            if (is_strip) {
                add_to_strip(run++, static_cast<int>(index));
            } else {
                soup_.corners.push_back(static_cast<int>(index));
            }
        }
        if (!is_strip) soup_.close_polygon();
    }

    /// Every second triangle of a strip runs the other way. Repeated corners only steer the strip.
    void add_to_strip(std::size_t run, int index) {
        if (run >= 2 && index != strip_[0] && index != strip_[1] && strip_[0] != strip_[1]) {
            const bool is_odd = run % 2 == 1;
            soup_.corners.push_back(strip_[is_odd ? 1 : 0]);
            soup_.corners.push_back(strip_[is_odd ? 0 : 1]);
            soup_.corners.push_back(index);
            soup_.close_polygon();
        }
        strip_[0] = strip_[1];
        strip_[1] = index;
    }

    TextCursor in_;
    PlyValues* values_ = nullptr;
    PolygonSoup soup_;
    std::string value_name_;  ///< of a vertex property asked for
    std::vector<double> vertex_values_;
    std::array<int, 2> strip_{};
};

template <typename Value>
void append_little_endian(TextWriter& out, Value value) {
    auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
    if (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    out << std::string_view(raw.data(), raw.size());
}

}  // namespace

VertexValues read_ply_values(std::string_view content, const std::string& source,
                             const std::string& property) {
    return PlyReader(content, source).vertex_values(property);
}

PolygonSoup read_ply(std::string_view content, const std::string& source) {
    return PlyReader(content, source).run();
}

std::string write_ply(const LoadedMesh& loaded) {
    const Mesh& mesh = loaded.mesh;
    TextWriter out;
    out << "ply\nformat binary_little_endian 1.0\n";
    if (!loaded.units.empty()) out << "comment units: " << loaded.units << '\n';
    out << "element vertex " << mesh.n_vertices()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
        << mesh.n_faces() << "\nproperty list uchar int vertex_indices\n";
    if (!loaded.face_labels.empty()) out << "property int label\n";
    const std::size_t edge_count = curve_edge_count(loaded);
    if (edge_count > 0)
        out << "element edge " << edge_count
            << "\nproperty int vertex1\nproperty int vertex2\nproperty int arc\n";
    out << "end_header\n";
    for (const auto vertex : mesh.vertices()) {
        for (double coordinate : mesh.point(vertex)) append_little_endian(out, coordinate);
    }
    for (const auto face : mesh.faces()) {
        out << '\3';
        for (VertexHandle vertex : face_vertices(mesh, face)) {
            append_little_endian(out, static_cast<std::int32_t>(vertex.idx()));
        }
        if (!loaded.face_labels.empty()) {
            append_little_endian(out, static_cast<std::int32_t>(label_of(loaded, face.idx())));
        }
    }
    for_each_curve_edge(loaded, [&](std::size_t curve, int from, int to) {
        for (const int number : {from, to, static_cast<int>(curve)})
            append_little_endian(out, static_cast<std::int32_t>(number));
    });
    return out.take();
}

}  // namespace fcn
