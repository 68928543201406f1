// The network's own format, lossless: every field of every struct, doubles in their shortest form
// that reads back to the same value, one element of a list on a line. A point is [x, y, z], and
// with its place on the surface [x, y, z, face, b0, b1, b2]. Absent keys take the defaults of
// network.h, unknown keys are errors, and what was read must pass validate().
// docs/fcn.schema.json describes the same.

#include <charconv>
#include <cmath>

#include "geometry/errors.h"
#include "geometry/text_writer.h"
#include "network/json_cursor.h"
#include "network/network_io.h"

namespace fcn {
namespace {

constexpr const char* kFormat = "scalefcn-network";
constexpr int kVersion = 1;

constexpr std::array<const char*, 3> kKindNames{"feature", "boundary", "label_border"};
constexpr std::array<const char*, 3> kPinNames{"none", "keep", "drop"};

// ---- writing

/// Writes JSON text; only strings need more than their digits.
class JsonText {
public:
    JsonText& operator<<(std::string_view text) {
        out_ << text;
        return *this;
    }
    // Without it a literal would rather be a bool than a string_view.
    JsonText& operator<<(const char* text) { return *this << std::string_view(text); }
    JsonText& operator<<(int value) {
        out_ << value;
        return *this;
    }
    JsonText& operator<<(bool value) { return *this << (value ? "true" : "false"); }
    JsonText& operator<<(double value) {
        // JSON has no NaN or infinity; validate() forbids them too.
        if (!std::isfinite(value)) throw LogicError("network_to_json: a number is not finite");
        if (value == 0 && std::signbit(value)) return *this << "-0.0";  // "-0" reads as integer
        out_ << value;
        return *this;
    }
    JsonText& operator<<(const Vec3& v) {
        return *this << "[" << v[0] << "," << v[1] << "," << v[2] << "]";
    }
    JsonText& string(const std::string& text) {
        // Bytes that are not UTF-8 (odd file names) become U+FFFD, not an unreadable file.
        constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
        return *this << std::string_view(nlohmann::json(text).dump(-1, ' ', false, kReplace));
    }
    template <typename Elements, typename Write>
    JsonText& list(const Elements& elements, std::string_view separator, const Write& write) {
        *this << "[";
        bool is_first = true;
        for (const auto& element : elements) {
            *this << (is_first ? separator.substr(separator.front() == ',') : separator);
            is_first = false;
            write(element);
        }
        return *this << "]";
    }
    template <typename Elements>
    JsonText& list(const Elements& elements) {
        return list(elements, ",", [&](const auto& element) { *this << element; });
    }
    std::string take() { return out_.take(); }

private:
    TextWriter out_;
};

template <typename Point>
void write_point(JsonText& out, const Point& point) {
    const SurfacePoint& surface = point.surface;
    if (surface.face == -1 && surface.barycentric == Vec3::Zero()) {
        out << point.position;
        return;
    }
    const Vec3 &p = point.position, &b = surface.barycentric;
    out << "[" << p[0] << "," << p[1] << "," << p[2] << "," << surface.face << "," << b[0] << ","
        << b[1] << "," << b[2] << "]";
}

void write_element(JsonText& out, const NetworkNode& node) { write_point(out, node); }

void write_element(JsonText& out, const NetworkArc& arc) {
    out << "{\"nodes\":";
    out.list(arc.nodes) << ",\"curve\":" << arc.curve << ",\"patches\":";
    out.list(arc.patches) << ",\"kind\":\"" << kKindNames[static_cast<std::size_t>(arc.kind)]
                          << "\",\"pin\":\"" << kPinNames[static_cast<std::size_t>(arc.pin)]
                          << "\",\"source\":";
    out.string(arc.source) << ",\"dihedral\":" << arc.dihedral << ",\"samples\":";
    out.list(arc.samples, ",", [&](const ArcSample& sample) { write_point(out, sample); });
    out << ",\"origins\":";
    out.list(arc.origins) << "}";
}

void write_element(JsonText& out, const NetworkSegment& segment) {
    out << "{\"nodes\":";
    out.list(segment.nodes) << ",\"arc\":" << segment.arc
                            << ",\"first_sample\":" << segment.first_sample
                            << ",\"last_sample\":" << segment.last_sample
                            << ",\"weight\":" << segment.weight
                            << ",\"is_long\":" << segment.is_long << "}";
}

void write_element(JsonText& out, const NetworkCurve& curve) {
    out << "{\"arcs\":";
    out.list(curve.arcs) << ",\"is_reversed\":";
    out.list(curve.is_reversed, ",", [&](bool is_reversed) { out << is_reversed; })
        << ",\"is_closed\":" << curve.is_closed << ",\"length\":" << curve.length << "}";
}

void write_element(JsonText& out, const SymmetryOrbit& orbit) {
    out << "{\"members\":";
    out.list(orbit.members, ",", [&](const OrbitMember& member) {
        out << "{\"arc\":" << member.arc << ",\"linear\":[";
        for (int row = 0; row < 3; ++row)
            out << (row > 0 ? "," : "") << Vec3(member.linear.row(row).transpose());
        out << "],\"translation\":" << member.translation
            << ",\"is_reversed\":" << member.is_reversed << "}";
    }) << "}";
}

void write_element(JsonText& out, const DroppedPiece& piece) {
    out << "{\"origin_arc\":" << piece.origin_arc << ",\"iteration\":" << piece.iteration
        << ",\"label\":" << piece.label << ",\"reason\":";
    out.string(piece.reason) << ",\"blockers\":";
    out.list(piece.blockers, ",",
             [&](const Blocker& blocker) {
                 out << "{\"label\":" << blocker.label << ",\"origin_arc\":" << blocker.origin_arc
                     << ",\"weight\":" << blocker.weight << ",\"conflict\":";
                 out.string(blocker.conflict) << ",\"measured\":" << blocker.measured << "}";
             })
        << ",\"weight\":" << piece.weight;
    out << ",\"margin\":";
    if (piece.margin)
        out << *piece.margin;
    else
        out << "null";
    out << ",\"polyline\":";
    out.list(piece.polyline) << "}";
}

void write_element(JsonText& out, const std::string& note) { out.string(note); }

template <typename Element>
void write_list(JsonText& out, const char* key, const std::vector<Element>& elements) {
    out << ",\n\"" << key << "\": ";
    out.list(elements, ",\n", [&](const Element& element) { write_element(out, element); });
}

std::string hash_text(std::uint64_t hash) {
    std::array<char, 16> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), hash, 16).ptr;
    const std::string text(digits.data(), end);
    return std::string(16 - text.size(), '0') + text;
}

// ---- reading

Vec3 read_vector(const JsonCursor& at) {
    at.expect_array(3);
    return {at.element(0).number(), at.element(1).number(), at.element(2).number()};
}

template <typename Point>
Point read_point(const JsonCursor& at) {
    const std::size_t size = at.expect_array();
    if (size != 3 && size != 7) at.fail("[x, y, z] or [x, y, z, face, b0, b1, b2]");
    Point point;
    for (int k = 0; k < 3; ++k) point.position[k] = at.element(k).number();
    if (size == 3) return point;
    point.surface.face = at.element(3).integer(-1);
    for (int k = 0; k < 3; ++k) point.surface.barycentric[k] = at.element(4 + k).number();
    return point;
}

template <typename Reader>
auto read_list(const JsonCursor& at, const Reader& read) {
    std::vector<decltype(read(at))> list;
    const std::size_t size = at.expect_array();
    list.reserve(size);
    for (std::size_t k = 0; k < size; ++k) list.push_back(read(at.element(k)));
    return list;
}

int read_integer(const JsonCursor& at) { return at.integer(); }
bool read_boolean(const JsonCursor& at) { return at.boolean(); }
std::string read_string(const JsonCursor& at) { return at.string(); }

std::array<int, 2> read_pair(const JsonCursor& at, int least) {
    at.expect_array(2);
    return {at.element(0).integer(least), at.element(1).integer(least)};
}

template <typename Enum>
Enum read_name(const JsonCursor& at, const std::array<const char*, 3>& names) {
    const std::string& name = at.string();
    for (std::size_t k = 0; k < names.size(); ++k)
        if (name == names[k]) return static_cast<Enum>(k);
    at.fail(std::string("\"") + names[0] + "\", \"" + names[1] + "\" or \"" + names[2] + "\"");
}

NetworkArc read_arc(const JsonCursor& at) {
    at.expect_object(
        {"nodes", "curve", "patches", "kind", "pin", "source", "dihedral", "samples", "origins"});
    NetworkArc arc;
    arc.nodes = read_pair(at.at("nodes"), 0);
    arc.samples = read_list(at.at("samples"), read_point<ArcSample>);
    if (at.has("origins")) arc.origins = read_list(at.at("origins"), read_integer);
    if (at.has("curve")) arc.curve = at.at("curve").integer(-1);
    if (at.has("patches")) arc.patches = read_pair(at.at("patches"), -1);
    if (at.has("kind")) arc.kind = read_name<ArcKind>(at.at("kind"), kKindNames);
    if (at.has("pin")) arc.pin = read_name<Pin>(at.at("pin"), kPinNames);
    if (at.has("source")) arc.source = at.at("source").string();
    if (at.has("dihedral")) arc.dihedral = at.at("dihedral").number();
    return arc;
}

NetworkSegment read_segment(const JsonCursor& at) {
    at.expect_object({"nodes", "arc", "first_sample", "last_sample", "weight", "is_long"});
    NetworkSegment segment;
    segment.nodes = read_pair(at.at("nodes"), 0);
    segment.arc = at.at("arc").integer(0);
    segment.first_sample = at.at("first_sample").integer(0);
    segment.last_sample = at.at("last_sample").integer(0);
    if (at.has("weight")) segment.weight = at.at("weight").number();
    if (at.has("is_long")) segment.is_long = at.at("is_long").boolean();
    return segment;
}

NetworkCurve read_curve(const JsonCursor& at) {
    at.expect_object({"arcs", "is_reversed", "is_closed", "length"});
    NetworkCurve curve;
    curve.arcs = read_list(at.at("arcs"), read_integer);
    curve.is_reversed = read_list(at.at("is_reversed"), read_boolean);
    if (at.has("is_closed")) curve.is_closed = at.at("is_closed").boolean();
    if (at.has("length")) curve.length = at.at("length").number();
    return curve;
}

OrbitMember read_member(const JsonCursor& at) {
    at.expect_object({"arc", "linear", "translation", "is_reversed"});
    OrbitMember member;
    member.arc = at.at("arc").integer(0);
    if (at.has("linear")) {
        const JsonCursor linear = at.at("linear");
        linear.expect_array(3);
        for (int row = 0; row < 3; ++row)
            member.linear.row(row) = read_vector(linear.element(row)).transpose();
    }
    if (at.has("translation")) member.translation = read_vector(at.at("translation"));
    if (at.has("is_reversed")) member.is_reversed = at.at("is_reversed").boolean();
    return member;
}

SymmetryOrbit read_orbit(const JsonCursor& at) {
    at.expect_object({"members"});
    return {read_list(at.at("members"), read_member)};
}

Blocker read_blocker(const JsonCursor& at) {
    at.expect_object({"label", "origin_arc", "weight", "conflict", "measured"});
    Blocker blocker;
    blocker.label = at.at("label").integer(-1);
    if (at.has("origin_arc")) blocker.origin_arc = at.at("origin_arc").integer(-1);
    if (at.has("weight")) blocker.weight = at.at("weight").number();
    if (at.has("conflict")) blocker.conflict = at.at("conflict").string();
    if (at.has("measured")) blocker.measured = at.at("measured").number();
    return blocker;
}

DroppedPiece read_dropped(const JsonCursor& at) {
    at.expect_object(
        {"origin_arc", "iteration", "label", "reason", "blockers", "weight", "margin", "polyline"});
    DroppedPiece piece;
    piece.polyline = read_list(at.at("polyline"), read_vector);
    if (at.has("origin_arc")) piece.origin_arc = at.at("origin_arc").integer(-1);
    if (at.has("iteration")) piece.iteration = at.at("iteration").integer(0);
    if (at.has("label")) piece.label = at.at("label").integer(-1);
    if (at.has("reason")) piece.reason = at.at("reason").string();
    if (at.has("blockers")) piece.blockers = read_list(at.at("blockers"), read_blocker);
    if (at.has("weight")) piece.weight = at.at("weight").number();
    if (at.has("margin") && !at.at("margin").is_null()) piece.margin = at.at("margin").number();
    return piece;
}

std::uint64_t read_hash(const JsonCursor& at) {
    const std::string& text = at.string();
    std::uint64_t hash = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
    if (error != std::errc() || end != text.data() + text.size() || text.empty())
        at.fail("up to 16 hexadecimal digits");
    return hash;
}

void check_version(const JsonCursor& at) {
    at.expect_object({"format", "version", "mesh_name", "mesh_hash", "units", "diagonal", "scale",
                      "ratio", "nodes", "arcs", "segments", "curves", "orbits", "dropped",
                      "origin_curves", "notes"});
    if (at.at("format").string() != kFormat)
        at.at("format").fail(std::string("\"") + kFormat + "\"");
    if (at.at("version").integer() != kVersion)
        at.at("version").fail("version " + std::to_string(kVersion));
}

FeatureCurveNetwork read_document(const JsonCursor& at) {
    check_version(at);
    FeatureCurveNetwork network;
    if (at.has("mesh_name")) network.mesh_name = at.at("mesh_name").string();
    if (at.has("mesh_hash")) network.mesh_hash = read_hash(at.at("mesh_hash"));
    if (at.has("units")) network.units = at.at("units").string();
    if (at.has("diagonal")) network.diagonal = at.at("diagonal").number();
    if (at.has("scale")) network.scale = at.at("scale").number();
    if (at.has("ratio")) network.ratio = at.at("ratio").number();
    network.nodes = read_list(at.at("nodes"), read_point<NetworkNode>);
    network.arcs = read_list(at.at("arcs"), read_arc);
    if (at.has("segments")) network.segments = read_list(at.at("segments"), read_segment);
    if (at.has("curves")) network.curves = read_list(at.at("curves"), read_curve);
    if (at.has("orbits")) network.orbits = read_list(at.at("orbits"), read_orbit);
    if (at.has("dropped")) network.dropped = read_list(at.at("dropped"), read_dropped);
    if (at.has("origin_curves"))
        network.origin_curves = read_list(at.at("origin_curves"), read_integer);
    if (at.has("notes")) network.notes = read_list(at.at("notes"), read_string);
    return network;
}

}  // namespace

std::string network_to_json(const FeatureCurveNetwork& network) {
    JsonText out;
    out << "{\n\"format\": \"" << kFormat << "\",\n\"version\": " << kVersion
        << ",\n\"mesh_name\": ";
    out.string(network.mesh_name) << ",\n\"mesh_hash\": \"" << hash_text(network.mesh_hash)
                                  << "\",\n\"units\": ";
    out.string(network.units) << ",\n\"diagonal\": " << network.diagonal
                              << ",\n\"scale\": " << network.scale
                              << ",\n\"ratio\": " << network.ratio;
    write_list(out, "nodes", network.nodes);
    write_list(out, "arcs", network.arcs);
    write_list(out, "segments", network.segments);
    write_list(out, "curves", network.curves);
    write_list(out, "orbits", network.orbits);
    write_list(out, "dropped", network.dropped);
    out << ",\n\"origin_curves\": ";
    out.list(network.origin_curves);
    write_list(out, "notes", network.notes);
    out << "\n}\n";
    return out.take();
}

FeatureCurveNetwork network_from_json(const std::string& text, const std::string& file_name) {
    nlohmann::json document;
    try {
        document = nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& error) {
        std::string what = error.what();  // "[json.exception...] parse error at line 3, ..."
        const std::size_t prefix = what.find("] ");
        if (prefix != std::string::npos) what = what.substr(prefix + 2);
        throw InputError(file_name + ": " + what);
    }
    FeatureCurveNetwork network = read_document(JsonCursor(document, file_name));
    const std::vector<std::string> problems = validate(network);
    if (!problems.empty())
        throw InputError(file_name + ": " + problems.front() +
                         (problems.size() == 1
                              ? std::string()
                              : " (and " + std::to_string(problems.size() - 1) + " more)"));
    return network;
}

}  // namespace fcn
