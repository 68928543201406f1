#include "adaptation/dropped_pieces.h"

#include <array>
#include <set>

#include "adaptation/network_output.h"

namespace fcn {
namespace {

/// A dropped piece of which this share came back is no longer listed as dropped.
constexpr double kCameBack = 0.5;

}  // namespace

void DroppedPieces::add(const WorkingArc& arc, int first, int last, int iteration,
                        DroppedPiece why) {
    why.polyline.assign(arc.points.begin() + first, arc.points.begin() + last + 1);
    why.origin_arc = majority_origin(arc, first, last);
    why.iteration = iteration;
    pieces_.push_back(std::move(why));
}

void DroppedPieces::add(const WorkingArc& arc, int iteration, const char* reason,
                        DroppedPiece why) {
    why.reason = reason;
    add(arc, 0, static_cast<int>(arc.points.size()) - 1, iteration, std::move(why));
}

void DroppedPieces::forget_returned(const WorkingNetwork& network) {
    std::set<std::array<double, 3>> present;
    for (const WorkingArc& arc : network.arcs) {
        for (const Vec3& p : arc.points) present.insert({p.x(), p.y(), p.z()});
    }
    std::erase_if(pieces_, [&](const DroppedPiece& piece) {
        std::size_t back = 0;
        for (const Vec3& p : piece.polyline) back += present.contains({p.x(), p.y(), p.z()});
        return piece.polyline.size() > 2 &&
               static_cast<double>(back) > kCameBack * static_cast<double>(piece.polyline.size());
    });
}

}  // namespace fcn
