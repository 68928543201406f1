#pragma once

#include <array>
#include <vector>

#include "features/polyline_tree.h"
#include "features/surface_lines.h"

namespace fcn {

/// A stretch of a later arc that stays. Its ends are nodes of the later network, or attached to a
/// place on the earlier one (place.arc >= 0), which `samples` then leave out.
struct ArcPiece {
    std::vector<ArcSample> samples;
    std::array<PolylinePlace, 2> attachments;
};

struct ArcCuts {
    std::vector<ArcPiece> pieces;
    /// Places on the earlier network that stand for what is left out, in order along each stretch.
    std::vector<std::vector<PolylinePlace>> fused;
};

/// One end of a later arc as its node has been decided on.
struct CutEnd {
    PolylinePlace place;      ///< arc >= 0: the node is fused with this place
    bool is_dead_end = true;  ///< no other arc ends here
};

/// Compares arcs of a later network with an earlier one. Keeps references.
class ArcCutter {
public:
    /// `reach`: what runs along an earlier arc within it is fused; mesh units, > 0.
    ArcCutter(const FeatureCurveNetwork& earlier, const PolylineTree& tree,
              const SurfaceLines& lines, double reach);

    /// The place of a node of the later network on the earlier one; arc = -1: none within reach.
    PolylinePlace place_of(const NetworkNode& node) const;
    /// `is_ring`: closed, and no other arc ends at its node.
    ArcCuts cut(const NetworkArc& arc, const std::array<CutEnd, 2>& ends, bool is_ring) const;

private:
    struct Probe;
    struct Event;
    struct Line;
    Line make_line(const std::vector<ArcSample>& samples) const;
    std::vector<ArcSample> rotated(const std::vector<ArcSample>& samples, double at) const;
    PolylinePlace closest(const Vec3& point, const Vec3& normal, double reach) const;
    Vec3 normal_at(const PolylinePlace& place) const;
    bool is_along(const std::vector<Probe>& probes, std::size_t k) const;
    std::vector<Event> crossings(const Line& line, double from, double to) const;
    std::vector<Event> touched_dead_ends(const Line& line, std::size_t first,
                                         std::size_t last) const;
    ArcSample sample_at(const Line& line, double at) const;
    void cut_line(const Line& line, const std::array<CutEnd, 2>& ends, ArcCuts& cuts) const;
    void add_run(const Line& line, std::size_t first, std::size_t last,
                 const std::array<CutEnd, 2>& ends, ArcCuts& cuts) const;
    void add_piece(const Line& line, const Event& from, const Event& to, bool is_held,
                   ArcCuts& cuts) const;

    const FeatureCurveNetwork& earlier_;
    const PolylineTree& tree_;
    const SurfaceLines& lines_;
    double reach_;
    std::vector<std::vector<Vec3>> normals_;  ///< per arc and sample of the earlier network
    std::vector<int> valences_;
};

}  // namespace fcn
