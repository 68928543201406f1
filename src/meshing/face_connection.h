#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// Two neighbouring faces.
struct FaceLink {
    int from = -1, to = -1;
    int halfedge = -1;     ///< of `from`, across it lies `to`
    double rotation = 0;   ///< from the frame of `from` to that of `to`, radians
    double stiffness = 0;  ///< what a unit of bending costs, > 0, dimensionless
};

/// How the frames of the faces of a mesh relate (frames: cross_field.h), one link an inner edge.
struct FaceConnection {
    std::vector<FaceLink> links;
    std::vector<double> areas;  ///< per face
};

struct ConnectionOptions {
    /// Curvature is spread over about this length, mesh units; 0: the surface as it is.
    double smoothing = 0;
    /// Per vertex: its curvature stays where it is; may be empty.
    std::vector<bool> is_kept;
};

/// Linear in the mesh but for one sparse factorisation if smoothing. Deterministic.
FaceConnection connect_faces(const Mesh& mesh, const ConnectionOptions& options = {});

}  // namespace fcn
