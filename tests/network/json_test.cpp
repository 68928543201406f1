#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "geometry/errors.h"
#include "network/network_io.h"
#include "network/sample_networks.h"

namespace fcn {
namespace {

using namespace fcn::testing;

/// Field by field, in words, so that nothing relies on the writer under test.
void expect_same(const FeatureCurveNetwork& a, const FeatureCurveNetwork& b) {
    EXPECT_EQ(a.mesh_name, b.mesh_name);
    EXPECT_EQ(a.mesh_hash, b.mesh_hash);
    EXPECT_EQ(a.units, b.units);
    EXPECT_EQ(a.diagonal, b.diagonal);
    EXPECT_EQ(a.scale, b.scale);
    EXPECT_EQ(a.ratio, b.ratio);
    EXPECT_EQ(a.notes, b.notes);
    const auto expect_same_point = [](const auto& p, const auto& q) {
        EXPECT_EQ(p.position, q.position);
        EXPECT_EQ(p.surface.face, q.surface.face);
        EXPECT_EQ(p.surface.barycentric, q.surface.barycentric);
    };
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t n = 0; n < a.nodes.size(); ++n) expect_same_point(a.nodes[n], b.nodes[n]);
    ASSERT_EQ(a.arcs.size(), b.arcs.size());
    for (std::size_t k = 0; k < a.arcs.size(); ++k) {
        const NetworkArc &p = a.arcs[k], &q = b.arcs[k];
        EXPECT_EQ(p.nodes, q.nodes);
        EXPECT_EQ(p.origins, q.origins);
        EXPECT_EQ(p.curve, q.curve);
        EXPECT_EQ(p.patches, q.patches);
        EXPECT_EQ(p.kind, q.kind);
        EXPECT_EQ(p.pin, q.pin);
        EXPECT_EQ(p.source, q.source);
        EXPECT_EQ(p.dihedral, q.dihedral);
        ASSERT_EQ(p.samples.size(), q.samples.size());
        for (std::size_t s = 0; s < p.samples.size(); ++s)
            expect_same_point(p.samples[s], q.samples[s]);
    }
    ASSERT_EQ(a.segments.size(), b.segments.size());
    for (std::size_t k = 0; k < a.segments.size(); ++k) {
        const NetworkSegment &p = a.segments[k], &q = b.segments[k];
        EXPECT_EQ(p.nodes, q.nodes);
        EXPECT_EQ(p.arc, q.arc);
        EXPECT_EQ(p.first_sample, q.first_sample);
        EXPECT_EQ(p.last_sample, q.last_sample);
        EXPECT_EQ(p.weight, q.weight);
        EXPECT_EQ(p.is_long, q.is_long);
    }
    ASSERT_EQ(a.curves.size(), b.curves.size());
    for (std::size_t k = 0; k < a.curves.size(); ++k) {
        EXPECT_EQ(a.curves[k].arcs, b.curves[k].arcs);
        EXPECT_EQ(a.curves[k].is_reversed, b.curves[k].is_reversed);
        EXPECT_EQ(a.curves[k].is_closed, b.curves[k].is_closed);
        EXPECT_EQ(a.curves[k].length, b.curves[k].length);
    }
    ASSERT_EQ(a.orbits.size(), b.orbits.size());
    for (std::size_t k = 0; k < a.orbits.size(); ++k) {
        ASSERT_EQ(a.orbits[k].members.size(), b.orbits[k].members.size());
        for (std::size_t m = 0; m < a.orbits[k].members.size(); ++m) {
            const OrbitMember &p = a.orbits[k].members[m], &q = b.orbits[k].members[m];
            EXPECT_EQ(p.arc, q.arc);
            EXPECT_EQ(p.linear, q.linear);
            EXPECT_EQ(p.translation, q.translation);
            EXPECT_EQ(p.is_reversed, q.is_reversed);
        }
    }
    ASSERT_EQ(a.dropped.size(), b.dropped.size());
    for (std::size_t k = 0; k < a.dropped.size(); ++k) {
        const DroppedPiece &p = a.dropped[k], &q = b.dropped[k];
        EXPECT_EQ(p.polyline, q.polyline);
        EXPECT_EQ(p.origin_arc, q.origin_arc);
        EXPECT_EQ(p.iteration, q.iteration);
        EXPECT_EQ(p.label, q.label);
        EXPECT_EQ(p.reason, q.reason);
        EXPECT_EQ(p.blockers, q.blockers);
        EXPECT_EQ(p.margin, q.margin);
        EXPECT_EQ(p.weight, q.weight);
    }
}

TEST(FcnJson, EveryFieldSurvives) {
    const FeatureCurveNetwork network = adapted_cube();
    ASSERT_TRUE(validate(network).empty()) << validate(network).front();
    const std::string text = network_to_json(network);
    const FeatureCurveNetwork back = network_from_json(text, "cube");
    expect_same(network, back);
    EXPECT_EQ(network_to_json(back), text);
}

/// Follows document and schema together: objects have exactly the schema's keys, names are among
/// its enums, and types are as it says.
void expect_described(const nlohmann::json& value, nlohmann::json schema,
                      const nlohmann::json& root, const std::string& where) {
    SCOPED_TRACE(where);
    if (schema.contains("$ref")) {
        const nlohmann::json::json_pointer target(schema["$ref"].get<std::string>().substr(1));
        schema.merge_patch(root.at(target));
    }
    if (schema.contains("oneOf")) {
        for (const nlohmann::json& option : schema["oneOf"]) {
            nlohmann::json resolved = option;
            if (option.contains("$ref"))
                resolved = root.at(
                    nlohmann::json::json_pointer(option["$ref"].get<std::string>().substr(1)));
            if (resolved["minItems"] == value.size())
                return expect_described(value, resolved, root, where);
        }
        FAIL() << "no option of " << value.size() << " elements";
    }
    if (schema.contains("const")) {
        EXPECT_EQ(value, schema["const"]);
    }
    if (schema.contains("enum")) {
        EXPECT_EQ(std::count(schema["enum"].begin(), schema["enum"].end(), value), 1) << value;
    }
    if (!schema.contains("type")) return;
    if (schema["type"].is_array()) {  // one of several
        const auto& types = schema["type"];
        EXPECT_EQ(std::count(types.begin(), types.end(), value.type_name()), 1) << value;
        return;
    }
    const std::string type = schema["type"];
    EXPECT_TRUE(type == value.type_name() || (type == "integer" && value.is_number_integer()))
        << value.type_name() << ", not " << type;
    if (type == "object") {
        for (const auto& [key, item] : schema["properties"].items())
            EXPECT_TRUE(value.contains(key)) << key << " is described but not written";
        for (const auto& [key, item] : value.items()) {
            ASSERT_TRUE(schema["properties"].contains(key)) << key << " is not described";
            expect_described(item, schema["properties"][key], root, where + "/" + key);
        }
    } else if (type == "array" && schema.contains("items")) {
        for (std::size_t k = 0; k < value.size(); ++k)
            expect_described(value[k], schema["items"], root, where + "/" + std::to_string(k));
    }
}

TEST(FcnJson, SchemaDescribesWhatIsWritten) {
    const nlohmann::json schema = nlohmann::json::parse(
        std::ifstream(std::string(SCALEFCN_SOURCE_DIR) + "/docs/fcn.schema.json"));
    expect_described(nlohmann::json::parse(network_to_json(adapted_cube())), schema, schema, "");
}

TEST(FcnJson, EmptyNetworkSurvives) {
    expect_same({}, network_from_json(network_to_json({}), "empty"));
}

TEST(FcnJson, RandomNetworksSurvive) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        FeatureCurveNetwork network = random_network(seed, 12, 30);
        find_curves(network);
        expect_same(network, network_from_json(network_to_json(network), "random"));
    }
}

TEST(FcnJson, OddNumbersSurvive) {
    FeatureCurveNetwork network = y_junction();
    network.arcs[0].dihedral = -0.0;
    network.arcs[1].dihedral = std::numeric_limits<double>::denorm_min();
    network.diagonal = std::numeric_limits<double>::max();
    const FeatureCurveNetwork back = network_from_json(network_to_json(network), "odd");
    expect_same(network, back);
    EXPECT_TRUE(std::signbit(back.arcs[0].dihedral));
}

TEST(FcnJson, NonFiniteNumbersAreNotWritten) {
    FeatureCurveNetwork network = y_junction();
    network.arcs[0].dihedral = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(network_to_json(network), LogicError);
}

/// What is wrong and the words that must be in the message.
struct BadDocument {
    std::string text;
    std::vector<std::string> words;
};

void expect_refused(const BadDocument& bad) {
    try {
        network_from_json(bad.text, "some.fcn.json");
        FAIL() << "accepted: " << bad.text;
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("some.fcn.json"), std::string::npos) << message;
        for (const std::string& word : bad.words)
            EXPECT_NE(message.find(word), std::string::npos) << message << " lacks " << word;
    }
}

std::string document(const std::string& rest) {
    return R"({"format": "scalefcn-network", "version": 1)" + rest + "}";
}

TEST(FcnJson, BadDocumentsAreRefusedWithTheirPlace) {
    const std::string nodes = R"(, "nodes": [[0,0,0],[1,0,0]])";
    const std::string arc = R"("nodes": [0,1], "samples": [[0,0,0],[1,0,0]])";
    const std::string arcs = R"(, "arcs": [{)" + arc + "}]";
    network_from_json(document(nodes + arcs), "good");  // the smallest good one
    const std::vector<BadDocument> cases{
        {"", {"parse error", "line 1"}},
        {"{\"format\": \"scalefcn-network\",\n\"version\": 1,,}", {"line 2"}},
        {"[]", {"expected an object"}},
        {"{}", {"/format", "missing"}},
        {R"({"format": "other"})", {"/format", "\"other\""}},
        {R"({"format": "scalefcn-network", "version": 2})", {"/version", "2"}},
        {document(""), {"/nodes", "missing"}},
        {document(nodes), {"/arcs", "missing"}},
        {document(R"(, "pins": [])"), {"/pins", "unknown key"}},
        {document(R"(, "mesh_hash": "xyz")" + nodes + arcs), {"/mesh_hash", "\"xyz\""}},
        {document(R"(, "diagonal": "2")" + nodes + arcs), {"/diagonal", "a number", "\"2\""}},
        {document(R"(, "diagonal": -2)" + nodes + arcs), {"/diagonal", "-2"}},
        {document(R"(, "diagonal": 1e999)" + nodes + arcs), {"1e999"}},
        {document(R"(, "nodes": [[0,0]], "arcs": [])"), {"/nodes/0", "array of 2"}},
        {document(R"(, "nodes": [[0,0,null]], "arcs": [])"), {"/nodes/0/2", "null"}},
        {document(R"(, "nodes": [[0,0,0,2,0.5,0.6,0.1]], "arcs": [])"),
         {"/nodes/0", "barycentric"}},
        {document(R"(, "nodes": [[0,0,0,1.5,1,0,0]], "arcs": [])"), {"/nodes/0/3", "1.5"}},
        {document(nodes + R"(, "arcs": [{"samples": []}])"), {"/arcs/0/nodes", "missing"}},
        {document(nodes + R"(, "arcs": [{"nodes": [0,9], "samples": [[0,0,0],[1,0,0]]}])"),
         {"/arcs/0/nodes/1", "node 9", "2"}},
        {document(nodes + R"(, "arcs": [{"nodes": [0,4294967296], "samples": []}])"),
         {"/arcs/0/nodes/1", "4294967296"}},
        {document(nodes + R"(, "arcs": [{"nodes": [0,-3000000000], "samples": []}])"),
         {"/arcs/0/nodes/1", "-3000000000"}},
        {document(nodes + R"(, "arcs": [{"pin": "kept", )" + arc + "}]"),
         {"/arcs/0/pin", "\"kept\"", "\"keep\""}},
        {document(nodes + R"(, "arcs": [{"kind": 3, )" + arc + "}]"), {"/arcs/0/kind", "3"}},
        {document(nodes + R"(, "arcs": [{"colour": 3, )" + arc + "}]"), {"/arcs/0/colour"}},
        {document(nodes + R"(, "arcs": [{"patches": [0,-2], )" + arc + "}]"),
         {"/arcs/0/patches/1", "-2"}},
        {document(nodes + R"(, "arcs": [{"origins": [0, 0], )" + arc + "}]"),
         {"/arcs/0/origins", "2"}},
        {document(nodes + R"(, "arcs": [{"curve": 0, )" + arc + "}]"), {"/arcs/0/curve", "0"}},
        {document(nodes + arcs + R"(, "segments": [{"nodes": [0,1], "arc": 1,
             "first_sample": 0, "last_sample": 1}])"),
         {"/segments/0/arc", "1"}},
        {document(nodes + arcs + R"(, "curves": [{"arcs": [7], "is_reversed": [false]}])"),
         {"/curves/0/arcs/0", "7"}},
        {document(nodes + arcs + R"(, "orbits": [{"members": [{"arc": 0, "linear": [1]}]}])"),
         {"/orbits/0/members/0/linear", "array of 1"}},
        {document(nodes + arcs + R"(, "dropped": [{"polyline": [[0,0,0],[1,0,true]]}])"),
         {"/dropped/0/polyline/1/2", "true"}},
        {document(nodes + arcs + R"(, "notes": [1])"), {"/notes/0", "1"}},
        {std::string(100000, '['), {"parse error"}},
    };
    for (const BadDocument& bad : cases) {
        SCOPED_TRACE(bad.text.substr(0, 300));
        expect_refused(bad);
    }
}

}  // namespace
}  // namespace fcn
