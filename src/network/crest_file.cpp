// ridges.txt and ravines.txt as the program that goes with Yoshizawa, Belyaev, Seidel (2005) writes
// them: three counts V, E, N; V lines "x y z component"; N lines "ridgeness sphericalness
// cyclideness"; E lines "point point triangle". Triangle numbers mean the mesh that the program was
// given and are only checked to be numbers: on our mesh the closest points are found anyway.

#include "network/crest_file.h"

#include <algorithm>
#include <cctype>
#include <limits>

#include "geometry/errors.h"
#include "geometry/mesh_io.h"
#include "geometry/text_cursor.h"
#include "network/place_on_surface.h"

namespace fcn {
namespace {

std::string plain_name(const std::filesystem::path& path) {
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    return name;
}

int index_below(TextCursor& in, const char* what, std::size_t end) {
    const std::int64_t value = in.integer(what);
    if (value < 0 || value >= static_cast<std::int64_t>(end))
        in.fail(std::string(what) + " " + std::to_string(value) +
                " is out of range, must be below " + std::to_string(end));
    return static_cast<int>(value);
}

}  // namespace

bool is_crest_file_name(const std::filesystem::path& path) {
    const std::string name = plain_name(path);
    return name.ends_with("ridges.txt") || name.ends_with("ravines.txt");
}

CrestFile read_crest_file(std::string_view content, const std::string& source) {
    TextCursor in(content, source);
    CrestFile file;
    // The smallest entries: "0 0 0 0", "0 1 0", "0 0 0", each with the blank behind it.
    const std::size_t point_count = in.count("the number of points", 8);
    const std::size_t edge_count = in.count("the number of edges", 6);
    const std::size_t component_count = in.count("the number of components", 6);
    for (std::size_t k = 0; k < point_count; ++k) {
        file.points.push_back(in.point("a coordinate"));
        file.component_of_point.push_back(index_below(in, "component", component_count));
    }
    for (std::size_t k = 0; k < component_count; ++k) {
        CrestFile::Measures measures;
        measures.ridgeness = in.number("a ridgeness");
        measures.sphericalness = in.number("a sphericalness");
        measures.cyclideness = in.number("a cyclideness");
        file.components.push_back(measures);
    }
    for (std::size_t k = 0; k < edge_count; ++k) {
        const int from = index_below(in, "point", point_count);
        const int to = index_below(in, "point", point_count);
        file.edges.push_back({from, to});
        const std::int64_t triangle = in.integer("a triangle");
        if (triangle < -1 || triangle > std::numeric_limits<int>::max())
            in.fail("triangle " + std::to_string(triangle) + " is neither a number nor -1");
        file.triangles.push_back(static_cast<int>(triangle));
    }
    if (!in.peek().empty()) in.fail("more follows after the last edge: " + std::string(in.peek()));
    return file;
}

EdgeSoup crest_edges(const CrestFile& file, const CrestFile::Measures& thresholds) {
    EdgeSoup soup;
    soup.points = file.points;
    for (const auto& [from, to] : file.edges) {
        const int component = file.component_of_point[from];
        const CrestFile::Measures& own = file.components[component];
        if (own.ridgeness < thresholds.ridgeness || own.sphericalness < thresholds.sphericalness ||
            own.cyclideness < thresholds.cyclideness) {
            continue;
        }
        soup.edges.push_back({from, to, component});
    }
    return soup;
}

FeatureCurveNetwork read_crest_network(const std::filesystem::path& path,
                                       const CrestFile::Measures& thresholds, const Mesh& mesh,
                                       int first_patch) {
    const std::string source = path.string();
    const CrestFile file = read_crest_file(read_file(path), source);
    const EdgeSoup soup = crest_edges(file, thresholds);
    FeatureCurveNetwork network = chain_edges(soup);
    if (!network.arcs.empty()) place_on_surface(network, mesh, source);
    // Components share no point, so that the components of the network are those of the file.
    std::vector<int> line_of_node(network.nodes.size());
    for (std::size_t n = 0; n < line_of_node.size(); ++n) line_of_node[n] = static_cast<int>(n);
    const auto root = [&](int n) {
        while (line_of_node[n] != n) n = line_of_node[n] = line_of_node[line_of_node[n]];
        return n;
    };
    for (const NetworkArc& arc : network.arcs) {
        const int a = root(arc.nodes[0]), b = root(arc.nodes[1]);
        line_of_node[std::max(a, b)] = std::min(a, b);
    }
    const std::string name = plain_name(path);
    for (NetworkArc& arc : network.arcs) {
        if (name.ends_with("ridges.txt")) arc.source = "crest-ridge";
        if (name.ends_with("ravines.txt")) arc.source = "crest-ravine";
        const int patch = first_patch + root(arc.nodes[0]);
        arc.patches = {patch, patch};
    }
    const auto problems = validate(network, mesh);
    if (!problems.empty()) throw InputError(source + ": " + problems.front());
    return network;
}

}  // namespace fcn
