// The network's own format, lossless: every field of every struct, doubles in their shortest form
// that reads back to the same value, one element of a list on a line. A point is [x, y, z], and
// with its place on the surface [x, y, z, face, b0, b1, b2]. Absent keys take the defaults of
// network.h, unknown keys are errors, and what was read must pass validate().
// docs/fcn.schema.json describes the same.

#include <charconv>
#include <cmath>

#include "geometry/errors.h"
#include "network/json_cursor.h"
#include "network/network_io.h"

namespace fcn {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "scalefcn-network";
constexpr int kVersion = 1;

constexpr std::array<const char*, 3> kKindNames{"feature", "boundary", "label_border"};
constexpr std::array<const char*, 3> kPinNames{"none", "keep", "drop"};

// ---- writing

Json number(double value) {
    // JSON has no NaN or infinity; validate() forbids them too.
    if (!std::isfinite(value)) throw LogicError("network_to_json: a number is not finite");
    return value;
}

Json vector_json(const Vec3& v) { return Json::array({number(v[0]), number(v[1]), number(v[2])}); }

Json point_json(const Vec3& position, const SurfacePoint& surface) {
    Json point = vector_json(position);
    if (surface.face == -1 && surface.barycentric == Vec3::Zero()) return point;
    point.push_back(surface.face);
    for (int k = 0; k < 3; ++k) point.push_back(number(surface.barycentric[k]));
    return point;
}

Json to_json(const NetworkNode& node) { return point_json(node.position, node.surface); }

Json to_json(const NetworkArc& arc) {
    Json samples = Json::array();
    for (const ArcSample& sample : arc.samples)
        samples.push_back(point_json(sample.position, sample.surface));
    return {{"nodes", arc.nodes},
            {"curve", arc.curve},
            {"patches", arc.patches},
            {"kind", kKindNames[static_cast<std::size_t>(arc.kind)]},
            {"pin", kPinNames[static_cast<std::size_t>(arc.pin)]},
            {"source", arc.source},
            {"dihedral", number(arc.dihedral)},
            {"samples", std::move(samples)},
            {"origins", arc.origins}};
}

Json to_json(const NetworkSegment& segment) {
    return {{"nodes", segment.nodes},
            {"arc", segment.arc},
            {"first_sample", segment.first_sample},
            {"last_sample", segment.last_sample},
            {"weight", number(segment.weight)},
            {"is_long", segment.is_long}};
}

Json to_json(const NetworkCurve& curve) {
    return {{"arcs", curve.arcs},
            {"is_reversed", curve.is_reversed},
            {"is_closed", curve.is_closed},
            {"length", number(curve.length)}};
}

Json to_json(const SymmetryOrbit& orbit) {
    Json members = Json::array();
    for (const OrbitMember& member : orbit.members) {
        Json linear = Json::array();
        for (int row = 0; row < 3; ++row)
            linear.push_back(vector_json(member.linear.row(row).transpose()));
        members.push_back({{"arc", member.arc},
                           {"linear", std::move(linear)},
                           {"translation", vector_json(member.translation)},
                           {"is_reversed", member.is_reversed}});
    }
    return {{"members", std::move(members)}};
}

Json to_json(const DroppedPiece& piece) {
    Json polyline = Json::array();
    for (const Vec3& point : piece.polyline) polyline.push_back(vector_json(point));
    return {{"origin_arc", piece.origin_arc}, {"iteration", piece.iteration},
            {"label", piece.label},           {"reason", piece.reason},
            {"blockers", piece.blockers},     {"weight", number(piece.weight)},
            {"polyline", std::move(polyline)}};
}

Json to_json(const std::string& note) { return note; }

std::string dump(const Json& value) {
    // Bytes that are not UTF-8 (odd file names) become U+FFFD rather than an unreadable file.
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <typename Element>
void append_list(std::string& out, const char* key, const std::vector<Element>& elements) {
    out += std::string(",\n\"") + key + "\": [";
    for (std::size_t k = 0; k < elements.size(); ++k)
        out += (k == 0 ? "\n" : ",\n") + dump(to_json(elements[k]));
    out += "]";
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

DroppedPiece read_dropped(const JsonCursor& at) {
    at.expect_object(
        {"origin_arc", "iteration", "label", "reason", "blockers", "weight", "polyline"});
    DroppedPiece piece;
    piece.polyline = read_list(at.at("polyline"), read_vector);
    if (at.has("origin_arc")) piece.origin_arc = at.at("origin_arc").integer(-1);
    if (at.has("iteration")) piece.iteration = at.at("iteration").integer(0);
    if (at.has("label")) piece.label = at.at("label").integer(-1);
    if (at.has("reason")) piece.reason = at.at("reason").string();
    if (at.has("blockers")) piece.blockers = read_list(at.at("blockers"), read_integer);
    if (at.has("weight")) piece.weight = at.at("weight").number();
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
                      "notes"});
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
    if (at.has("notes")) network.notes = read_list(at.at("notes"), read_string);
    return network;
}

}  // namespace

std::string network_to_json(const FeatureCurveNetwork& network) {
    const Json header = {{"format", kFormat},
                         {"version", kVersion},
                         {"mesh_name", network.mesh_name},
                         {"mesh_hash", hash_text(network.mesh_hash)},
                         {"units", network.units},
                         {"diagonal", number(network.diagonal)},
                         {"scale", number(network.scale)},
                         {"ratio", number(network.ratio)}};
    std::string out = "{";
    for (auto item = header.begin(); item != header.end(); ++item)
        out +=
            (item == header.begin() ? "\n\"" : ",\n\"") + item.key() + "\": " + dump(item.value());
    append_list(out, "nodes", network.nodes);
    append_list(out, "arcs", network.arcs);
    append_list(out, "segments", network.segments);
    append_list(out, "curves", network.curves);
    append_list(out, "orbits", network.orbits);
    append_list(out, "dropped", network.dropped);
    append_list(out, "notes", network.notes);
    return out + "\n}\n";
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
