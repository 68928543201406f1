#pragma once

#include <algorithm>
#include <vector>

#include "meshing/reference_surface.h"
#include "meshing/size_sources.h"
#include "meshing/working_mesh.h"

namespace fcn {

/// How long edges should be.
struct EdgeTarget {
    double length = 0;                ///< > 0, mesh units
    std::vector<float> face_factors;  ///< per face of the reference surface; empty: 1 everywhere
    SizeSources sources;              ///< where edges are shorter than that
    SizeSources curve_sources;        ///< where features are cut into shorter edges, too

    double at(const Vec3& point) const {
        return sources.is_empty() ? length : std::min(length, sources.limit(point));
    }

    double at(const WorkingMesh& mesh, int vertex) const {
        const int place = mesh.place(vertex);
        const double own = face_factors.empty() || place < 0
                               ? length
                               : length * face_factors[static_cast<std::size_t>(place)];
        return sources.is_empty() ? own : std::min(own, sources.limit(mesh.point(vertex)));
    }
    double of_edge(const WorkingMesh& mesh, int h) const {
        return face_factors.empty() && sources.is_empty()
                   ? length
                   : std::min(at(mesh, mesh.from(h)), at(mesh, mesh.to(h)));
    }
};

/// Interval of lengths, in targets, in which remeshing leaves an edge alone (Botsch, Kobbelt 2004).
inline constexpr double kShortestEdge = 4.0 / 5, kLongestEdge = 4.0 / 3;

/// Cuts features that are much longer than their sources ask, at the point of `curves` nearest to
/// the middle; these vertices stay. Returns the number of cuts.
std::size_t cut_features(WorkingMesh& mesh, const ReferenceSurface& curves,
                         const EdgeTarget& target);

/// Halves edges longer than 4/3 of the target, longest first; features are left alone. New
/// vertices lie in the middle. Returns the number of splits.
std::size_t split_long_edges(WorkingMesh& mesh, const EdgeTarget& target);

// The steps below refuse what makes triangles cross at thin places (crossing_guard.h).

/// Collapses edges shorter than `share` targets, shortest first, where no edge becomes longer than
/// 4/3 of the target, no face turns far, and none becomes a needle. Vertices of curves move along
/// them. Returns the number of collapses.
std::size_t collapse_short_edges(WorkingMesh& mesh, const EdgeTarget& target, double share);

/// Collapses what is left of chains of features between fixed vertices, whatever lengths come of
/// it, and splits edges beside them that are in the way. Returns the number of changes.
std::size_t straighten_chains(WorkingMesh& mesh, const EdgeTarget& target);

/// Flips edges towards valence 6 (less at borders and corners), and where that does not matter
/// towards larger angles. Returns the number of flips.
std::size_t flip_for_valence(WorkingMesh& mesh, const EdgeTarget& target);

/// Flips edges where that raises the smallest angle of the two faces.
std::size_t flip_for_angles(WorkingMesh& mesh, const EdgeTarget& target);

/// Moves free vertices towards the centre of their stars in the tangent plane and back onto the
/// reference surface, on their own sheet. No face turns over.
void smooth(WorkingMesh& mesh, const ReferenceSurface& reference, const EdgeTarget& target);

}  // namespace fcn
