#pragma once

#include <map>
#include <string>
#include <vector>

#include "geometry/mesh_io.h"

namespace fcn {

/// What there is to say about quads made in one way.
struct QuadOutcome {
    std::string failure;  ///< empty: there is a mesh
    bool is_by_field = false;
    std::string reason;  ///< why not, or not at once
    std::size_t faces = 0, inverted_corners = 0, close_pairs = 0;
    double mean_jacobian = 0, least_jacobian = 0, irregular = 0;
    double hausdorff = 0;          ///< in edge lengths h
    double alignment_degrees = 0;  ///< off the adapted network, mean
    double cpu_seconds = 0;

    bool is_sound() const { return failure.empty() && inverted_corners == 0; }
};

/// A mesh at a scale.
struct QuadCase {
    std::string kind;  ///< of mesh, as the list has it
    std::string mesh;
    double scale = 0;  ///< h in percent of the diagonal
    std::size_t faces = 0;
    double triangle_hausdorff = 0;  ///< of the triangle remesh of the same network, in h
    bool has_network = false;
    std::map<std::string, QuadOutcome> ways;
};

/// One line of a list: kind, mesh, scales.
struct QuadTask {
    std::string kind, mesh;
    std::vector<double> scales;
};

/// Lines "KIND MESH SCALE...", # begins a comment. Throws InputError with the line.
std::vector<QuadTask> read_quad_tasks(const std::string& path);

/// What a case calls its mesh.
std::string quad_input_name(const std::string& mesh);

/// A file of the folder, a file, or "model:NAME[,count=8][,spacing=0.05][,resolution=0.02]".
LoadedMesh load_quad_input(const std::string& name, const std::string& folder);

/// Adapts to the scale and makes quads in every way. Pictures of sound ones go into `pictures`
/// unless that is empty.
QuadCase run_quad_case(const QuadTask& task, double scale, const LoadedMesh& mesh,
                       const std::vector<std::string>& ways, const std::string& pictures);

/// One line of JSON, and back.
std::string to_line(const QuadCase& one);
QuadCase from_line(const std::string& line);

}  // namespace fcn
