#pragma once

#include <limits>
#include <vector>

#include "meshing/remeshing_steps.h"

namespace fcn {

/// What is wrong with a triangle: 0 from the aim (34 degrees) on, growing steeply as its smallest
/// angle falls.
double angle_penalty(const Vec3& a, const Vec3& b, const Vec3& c);

/// How far trial changes may bend the surface.
struct PatchLimits {
    double max_turn = 0.8;    ///< cosine between a face's normal before and after
    double flatness = 0.9;    ///< cosine between faces at an edge that is flipped and their mean
    double deviation = 0.04;  ///< from the reference, in targets, where it is not larger already
};

/// A piece of a mesh around a face, in which trial changes take place: two rings of faces, of which
/// the inner one's vertices may move. Uses the mesh's journal.
class Patch {
public:
    Patch(WorkingMesh& mesh, const ReferenceSurface& reference, const EdgeTarget& target);

    void set_limits(const PatchLimits& limits) { limits_ = limits; }
    /// Takes the faces around `face`.
    void gather(int face);
    /// Sum of the penalties of what is in the patch now.
    double penalty() const;
    /// Largest distance of the faces' centres and edges' middles from the reference.
    double deviation() const;
    /// Flips and moves that lower the penalty, for some rounds.
    void relax();
    /// Faces now in the patch, with those that changes made.
    std::vector<int> faces() const;

private:
    bool is_inside(int face) const;
    std::size_t flip_edges();
    std::size_t move_vertices();
    bool move(int v);
    /// Of the faces at a vertex, were it at p; a part of it that is `enough` if it is not below
    /// that.
    double star_penalty(int v, const Vec3& p,
                        double enough = std::numeric_limits<double>::infinity()) const;
    bool turns_faces(int v, const Vec3& p) const;

    WorkingMesh& mesh_;
    const ReferenceSurface& reference_;
    const EdgeTarget& target_;
    PatchLimits limits_;
    std::vector<int> faces_;    ///< as gathered
    std::vector<int> movable_;  ///< vertices as gathered
    std::vector<int> stamps_;   ///< per face: the patch it was last part of
    int stamp_ = 0;
    int first_new_face_ = 0, first_new_vertex_ = 0;
};

}  // namespace fcn
