// PLY with an edge element: vertex1, vertex2, and of ours weight (w(e) of the segment), arc (from
// 0) and kept (0: a piece that adaptation dropped; then arc is its arc in the initial network).
// Written as text; read as text and binary of both byte orders. All other elements and properties
// are walked over.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"
#include "network/network_formats.h"

namespace fcn {
namespace {

struct TypeName {
    std::string_view old_name, new_name;
    std::size_t size;
    char kind;  ///< 'i' signed, 'u' unsigned, 'f' floating
};
constexpr std::array kTypes{
    TypeName{"char", "int8", 1, 'i'},     TypeName{"uchar", "uint8", 1, 'u'},
    TypeName{"short", "int16", 2, 'i'},   TypeName{"ushort", "uint16", 2, 'u'},
    TypeName{"int", "int32", 4, 'i'},     TypeName{"uint", "uint32", 4, 'u'},
    TypeName{"float", "float32", 4, 'f'}, TypeName{"double", "float64", 8, 'f'},
};

enum class Encoding { Text, Little, Big };

struct Property {
    std::string name;
    const TypeName* type = nullptr;
    const TypeName* count_type = nullptr;  ///< of a list
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

template <typename Value>
double load(const std::array<char, 8>& bytes) {
    Value value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
}

class PlyEdges {
public:
    PlyEdges(std::string_view content, const std::string& source) : in_(content, source) {}

    EdgeSoup run() {
        read_header();
        bool has_edges = false;
        for (const Element& element : elements_) {
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "edge") {
                read_edges(element);
                has_edges = true;
            } else {
                skip_rows(element);
            }
        }
        if (!has_edges) in_.fail("no edge element: no curves in it");
        for (const EdgeSoup::Edge& edge : soup_.edges)
            for (int point : {edge.from, edge.to}) check_index(point);
        collect_dropped();
        return std::move(soup_);
    }

private:
    // ---- header

    void read_header() {
        in_.expect("ply");
        for (std::string_view word = in_.token(); word != "end_header"; word = in_.token()) {
            if (word == "format") {
                read_format();
            } else if (word == "element") {
                Element element;
                element.name = in_.token_on_line();
                const std::int64_t count = in_.integer_on_line("an element count");
                if (count < 0) in_.fail("an element count is negative");
                element.count = static_cast<std::size_t>(count);
                elements_.push_back(element);
            } else if (word == "property") {
                read_property();
            } else if (word.empty()) {
                in_.fail("the header has no end_header");
            } else if (word != "comment" && word != "obj_info") {
                in_.fail("unknown header line: " + shown(word));
            }
            in_.skip_line();
        }
        in_.skip_line();
        if (!encoding_) in_.fail("the header has no format line");
        bytes_ = in_.remaining_text();
    }

    void read_format() {
        const std::string_view name = in_.token_on_line();
        if (name == "ascii")
            encoding_ = Encoding::Text;
        else if (name == "binary_little_endian")
            encoding_ = Encoding::Little;
        else if (name == "binary_big_endian")
            encoding_ = Encoding::Big;
        else
            in_.fail("unknown format " + shown(name));
    }

    const TypeName* read_type() {
        const std::string_view name = in_.token_on_line();
        for (const TypeName& type : kTypes)
            if (name == type.old_name || name == type.new_name) return &type;
        in_.fail("unknown property type " + shown(name));
    }

    void read_property() {
        if (elements_.empty()) in_.fail("a property before any element");
        Property property;
        std::string_view word = in_.peek();
        if (word == "list") {
            in_.token_on_line();
            property.count_type = read_type();
            if (property.count_type->kind == 'f') in_.fail("a list's length is no integer type");
        }
        property.type = read_type();
        property.name = in_.token_on_line();
        elements_.back().properties.push_back(property);
    }

    // ---- body

    double value(const TypeName& type, std::string_view what) {
        if (*encoding_ == Encoding::Text) return in_.number(what);
        if (bytes_.size() < type.size)
            in_.fail("the file ends within its binary part, before " + std::string(what));
        std::array<char, 8> bytes{};
        std::copy_n(bytes_.begin(), type.size, bytes.begin());
        bytes_.remove_prefix(type.size);
        const bool is_native =
            (*encoding_ == Encoding::Little) == (std::endian::native == std::endian::little);
        if (!is_native) std::reverse(bytes.begin(), bytes.begin() + type.size);
        switch (type.size) {
            case 1:
                return type.kind == 'i' ? load<std::int8_t>(bytes) : load<std::uint8_t>(bytes);
            case 2:
                return type.kind == 'i' ? load<std::int16_t>(bytes) : load<std::uint16_t>(bytes);
            case 4:
                return type.kind == 'i'   ? load<std::int32_t>(bytes)
                       : type.kind == 'u' ? load<std::uint32_t>(bytes)
                                          : load<float>(bytes);
            default:
                return load<double>(bytes);
        }
    }

    void skip_value(const TypeName& type) {
        if (*encoding_ != Encoding::Text)
            value(type, "a property");
        else if (in_.token().empty())
            in_.fail("the file ends within its elements");
    }

    void skip_property(const Property& property) {
        if (!property.count_type) {
            skip_value(*property.type);
            return;
        }
        const double count = value(*property.count_type, "the length of a list");
        if (!(count >= 0)) in_.fail("the length of a list is negative");
        for (double k = 0; k < count; ++k) skip_value(*property.type);
    }

    /// A count no body of this size can hold is a damaged header, not a reason to set memory aside.
    void check_count(const Element& element) {
        const std::size_t left = *encoding_ == Encoding::Text ? in_.remaining() : bytes_.size();
        if (element.count > left && !element.properties.empty())
            in_.fail(std::to_string(element.count) + " elements '" + element.name +
                     "' are declared, but only " + std::to_string(left) + " bytes follow");
    }

    void skip_rows(const Element& element) {
        check_count(element);
        if (element.properties.empty()) return;
        for (std::size_t row = 0; row < element.count; ++row)
            for (const Property& property : element.properties) skip_property(property);
    }

    /// Reads the rows of an element; `take(row, k, value)` gets the property wanted[k].
    template <typename Take>
    void read_rows(const Element& element, const std::vector<std::string_view>& wanted,
                   std::size_t required, const Take& take) {
        check_count(element);
        std::vector<int> slot;
        std::vector<bool> is_there(wanted.size(), false);
        for (const Property& property : element.properties) {
            const auto found = std::find(wanted.begin(), wanted.end(), property.name);
            const bool is_taken = found != wanted.end() && !property.count_type;
            slot.push_back(is_taken ? static_cast<int>(found - wanted.begin()) : -1);
            if (is_taken) is_there[slot.back()] = true;
        }
        for (std::size_t k = 0; k < required; ++k)
            if (!is_there[k])
                in_.fail("element '" + element.name + "' has no property " +
                         std::string(wanted[k]));
        for (std::size_t row = 0; row < element.count; ++row)
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                if (slot[p] < 0) {
                    skip_property(element.properties[p]);
                    continue;
                }
                const double x = value(*element.properties[p].type, element.properties[p].name);
                if (!std::isfinite(x)) in_.fail(element.properties[p].name + " is not finite");
                take(row, slot[p], x);
            }
    }

    void read_vertices(const Element& element) {
        if (!soup_.points.empty()) in_.fail("a second vertex element");
        // Grown row by row: the declared count is only a claim.
        read_rows(element, {"x", "y", "z"}, 3, [&](std::size_t row, int k, double x) {
            if (row == soup_.points.size()) soup_.points.push_back(Vec3::Zero());
            soup_.points.back()[k] = x;
        });
    }

    void read_edges(const Element& element) {
        read_rows(element, {"vertex1", "vertex2", "arc", "kept", "weight"}, 2,
                  [&](std::size_t row, int k, double x) {
                      if (row == weights_.size()) {
                          soup_.edges.push_back({});
                          is_kept_.push_back(true);
                          weights_.push_back(0);
                      }
                      EdgeSoup::Edge& edge = soup_.edges.back();
                      switch (k) {
                          case 0:
                              edge.from = to_integer(x, 0, "vertex1");
                              break;
                          case 1:
                              edge.to = to_integer(x, 0, "vertex2");
                              break;
                          case 2:
                              edge.arc = to_integer(x, -1, "arc");
                              break;
                          case 3:
                              is_kept_.back() = x != 0;
                              break;
                          default:
                              weights_.back() = x;
                      }
                  });
    }

    int to_integer(double x, int least, std::string_view what) const {
        if (x != std::floor(x) || x < least || x > std::numeric_limits<int>::max())
            in_.fail((TextWriter() << what << ' ' << x << " is out of range").take());
        return static_cast<int>(x);
    }

    void check_index(int point) const {
        if (point >= static_cast<int>(soup_.points.size()))
            in_.fail("an edge has vertex " + std::to_string(point) + ", the file has " +
                     std::to_string(soup_.points.size()));
    }

    /// Moves edges that were not kept into pieces: each is a run of edges that share vertices.
    void collect_dropped() {
        std::vector<EdgeSoup::Edge> kept;
        int last_point = -1;
        for (std::size_t e = 0; e < soup_.edges.size(); ++e) {
            const EdgeSoup::Edge& edge = soup_.edges[e];
            if (is_kept_[e]) {
                kept.push_back(edge);
                last_point = -1;
                continue;
            }
            if (edge.from != last_point || edge.arc != soup_.dropped.back().origin_arc) {
                soup_.dropped.push_back({});
                soup_.dropped.back().origin_arc = edge.arc;
                soup_.dropped.back().weight = weights_[e];
                soup_.dropped.back().polyline.push_back(soup_.points[edge.from]);
            }
            soup_.dropped.back().polyline.push_back(soup_.points[edge.to]);
            last_point = edge.to;
        }
        soup_.edges = std::move(kept);
    }

    TextCursor in_;
    std::optional<Encoding> encoding_;
    std::vector<Element> elements_;
    std::string_view bytes_;  ///< what is left of a binary body
    EdgeSoup soup_;
    std::vector<bool> is_kept_;
    std::vector<double> weights_;
};

}  // namespace

EdgeSoup read_ply_edges(std::string_view content, const std::string& source) {
    return PlyEdges(content, source).run();
}

std::string write_ply_edges(const WrittenNetwork& network) {
    std::size_t point_count = network.points.size(), edge_count = network.edge_count();
    for (const DroppedPiece& piece : network.dropped) {
        point_count += piece.polyline.size();
        edge_count += piece.polyline.size() - 1;
    }
    TextWriter out;
    out << "ply\nformat ascii 1.0\ncomment feature curve network\nelement vertex " << point_count
        << "\nproperty double x\nproperty double y\nproperty double z\nelement edge " << edge_count
        << "\nproperty int vertex1\nproperty int vertex2\nproperty double weight\n"
           "property int arc\nproperty uchar kept\nend_header\n";
    for (const Vec3& point : network.points) out << point << '\n';
    for (const DroppedPiece& piece : network.dropped)
        for (const Vec3& point : piece.polyline) out << point << '\n';
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        const WrittenNetwork::Arc& arc = network.arcs[a];
        for (std::size_t k = 0; k < arc.weights.size(); ++k)
            out << arc.points[k] << ' ' << arc.points[k + 1] << ' ' << arc.weights[k] << ' ' << a
                << " 1\n";
    }
    std::size_t point = network.points.size();
    for (const DroppedPiece& piece : network.dropped) {
        for (std::size_t k = 1; k < piece.polyline.size(); ++k, ++point)
            out << point << ' ' << point + 1 << ' ' << piece.weight << ' ' << piece.origin_arc
                << " 0\n";
        ++point;
    }
    return out.take();
}

}  // namespace fcn
