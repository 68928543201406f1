#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "network/chain_edges.h"

namespace fcn {

/// The files ridges.txt and ravines.txt of Yoshizawa's program: points of crest lines, connected
/// components with their measures, edges with the mesh triangle that they lie in.
struct CrestFile {
    struct Measures {
        double ridgeness = 0;
        double sphericalness = 0;
        double cyclideness = 0;
    };
    std::vector<Vec3> points;
    std::vector<int> component_of_point;
    std::vector<Measures> components;
    std::vector<std::array<int, 2>> edges;  ///< of points
    std::vector<int> triangles;             ///< per edge; -1 for one that connects components
};

/// Does the name end in ridges.txt or ravines.txt (any case, .gz may follow)?
bool is_crest_file_name(const std::filesystem::path& path);

/// Throws InputError "<source>:<line>: ..." on anything but such a file.
CrestFile read_crest_file(std::string_view content, const std::string& source);

/// The edges of the components that reach all three thresholds; the component is the arc number.
EdgeSoup crest_edges(const CrestFile& file, const CrestFile::Measures& thresholds = {});

/// Reads a crest file as a network on a mesh: components below a threshold are left out, arcs are
/// of source "crest-ridge" or "crest-ravine" (by name, else "import"), those of one component share
/// a patch id from `first_patch` on. Throws InputError.
FeatureCurveNetwork read_crest_network(const std::filesystem::path& path,
                                       const CrestFile::Measures& thresholds, const Mesh& mesh,
                                       int first_patch);

}  // namespace fcn
