#pragma once

#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace fcn {

/// A 4-fold rotationally symmetric direction in each face, and how neighbours match. The frame of a
/// face has x along its first halfedge (face_vertices[0] to [1]) and y to its left. Frames of two
/// faces are compared after unfolding the one into the plane of the other over their edge.
struct CrossField {
    std::vector<double> angles;  ///< per face: one arm, radians in the face's frame
    /// Per halfedge: the quarter turns, 0 .. 3, that take the arm of its face to the arm of the
    /// face across; turns(h) + turns(opposite) = 0 modulo 4. 0 where a boundary is on either side.
    std::vector<int> turns;
};

/// Angle in (-pi, pi] of a halfedge of an inner face in that face's frame.
double halfedge_angle(const Mesh& mesh, HalfedgeHandle h);

/// Inner angle of h's face where h starts, radians.
double corner_angle(const Mesh& mesh, HalfedgeHandle h);

/// From the direction of h, which has a face, to the nearest arm there, in [-pi / 4, pi / 4].
double nearest_arm(const Mesh& mesh, const CrossField& field, HalfedgeHandle h);

/// What is added to an angle in the frame of h's face to express the direction in the frame of the
/// face across h, after unfolding; in (-pi, pi]. Both sides must be faces.
double frame_rotation(const Mesh& mesh, HalfedgeHandle h);

/// What is left of the angle from an arm to the arm across h that its turns match it to, in
/// (-pi, pi]; antisymmetric.
double arm_rotation(const Mesh& mesh, const CrossField& field, HalfedgeHandle h);

/// The turns that match each arm to the nearest one across.
std::vector<int> nearest_turns(const Mesh& mesh, const std::vector<double>& angles);

/// Index of every vertex in quarters: what the field turns around it more than the surface does.
/// At boundaries turning is counted from and to the arms nearest to the boundary's edges. The sum
/// is 4 times the Euler characteristic, on open meshes too.
std::vector<int> vertex_indices(const Mesh& mesh, const CrossField& field);

/// The first broken property: sizes, range and antisymmetry of the turns, non-finite angles; empty
/// if none.
std::string first_fault(const Mesh& mesh, const CrossField& field);

}  // namespace fcn
