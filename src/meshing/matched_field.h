#pragma once

#include <vector>

#include "meshing/cross_field.h"
#include "meshing/face_connection.h"
#include "meshing/field_guides.h"

namespace fcn {

/// A cross field whose matching across edges is fixed: what changes then are the angles alone.
struct MatchedField {
    CrossField field;
    /// Per link of the connection: from the arm of `from`, turned, to the arm of `to`; real, not
    /// wrapped.
    std::vector<double> bends;
    std::vector<int> indices;  ///< per vertex (vertex_indices), kept up to date
};

/// Matches each arm to the nearest one across.
MatchedField match_arms(const Mesh& mesh, const FaceConnection& connection,
                        std::vector<double> angles);

/// Adds quarter turns across a link.
void turn_link(const Mesh& mesh, const FaceConnection& connection, std::size_t link, int turns,
               MatchedField& matched);

/// The same turns seen by another connection of the same mesh.
void reconnect(const FaceConnection& before, const FaceConnection& after, MatchedField& matched);

/// The smoothest angles with these turns (Bommes, Zimmer, Kobbelt 2009, with the integers fixed).
/// First without the guides that are more than `far` radians from the arms, which the turns may
/// have taken elsewhere; then each guide pulls the arm nearest to it. Returns whether the system
/// could be solved; otherwise nothing changes.
bool straighten(const FaceConnection& connection, const std::vector<FieldGuide>& guides,
                MatchedField& matched, double far = 0.5);

}  // namespace fcn
