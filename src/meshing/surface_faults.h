#pragma once

#include <vector>

#include "meshing/remeshing_steps.h"

namespace fcn {

/// A point of the reference surface that a mesh should come near.
struct SurfaceSample {
    Vec3 position = Vec3::Zero();
    int face = -1;  ///< of the reference
};

/// A sample that is far from a mesh.
struct FarSample {
    double distance = 0;
    SurfaceSample sample;
    int nearest_face = -1;  ///< of the mesh
};

/// What a remesh can be faulted for. Faces are those of the compacted mesh.
struct SurfaceFaults {
    /// Pairs of faces that intersect away from where the reference does.
    std::vector<std::array<int, 2>> crossings;
    /// Faces with an angle under 30 degrees that no two curves force; none if there are too many.
    std::vector<int> needles;
    bool has_too_many_needles = false;
    /// The reference's points farther from the mesh than a share of the target: the farthest, one
    /// in a ball of the target's radius, farthest first.
    std::vector<FarSample> far;
    double severity = 0;  ///< of all together; 0: no faults
};

/// Looks for faults of remeshes of one surface.
class FaultFinder {
public:
    /// Samples are the vertices of `mesh` and points of its creases, half an edge length apart.
    /// `has_fitting_features`: needles count however many there are, since no feature asks for
    /// them.
    FaultFinder(const Mesh& mesh, double edge_length, bool has_fitting_features = false);

    /// Time near-linear in the mesh and the samples.
    SurfaceFaults find(const WorkingMesh& mesh, const EdgeTarget& target) const;
    /// Only where the target's sources are felt, for a mesh that has no faults elsewhere. Needles
    /// count as they did `before`, so that severities can be compared.
    SurfaceFaults find_near_sources(const WorkingMesh& mesh, const EdgeTarget& target,
                                    const SurfaceFaults& before) const;

private:
    SurfaceFaults find_among(const WorkingMesh& mesh, const EdgeTarget& target,
                             const std::vector<int>& faces, bool is_everywhere) const;
    void find_crossings(const WorkingMesh& mesh, const std::vector<int>& faces,
                        SurfaceFaults& faults) const;
    void find_far(const WorkingMesh& mesh, const EdgeTarget& target, const std::vector<int>& faces,
                  bool is_everywhere, SurfaceFaults& faults) const;

    const Mesh& input_;
    double edge_length_;
    bool has_fitting_features_;
    std::vector<SurfaceSample> samples_;
    mutable bool is_input_known_ = false;
    mutable std::vector<Vec3> input_crossings_;  ///< asked for when a remesh has crossings
};

/// Centre of a face.
Vec3 face_center(const WorkingMesh& mesh, int face);

}  // namespace fcn
