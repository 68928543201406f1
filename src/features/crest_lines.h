#pragma once

#include <vector>

#include "features/crest_crossings.h"

namespace fcn {

/// A crest line: points joined by pieces, running straight on where lines fork.
struct CrestLine {
    std::vector<int> points;  ///< of the graph; a closed line repeats its first
    std::vector<int> pieces;  ///< of the graph, one less than points
    bool is_closed = false;
};

/// Partition of the pieces into lines: at a fork the two ends that continue each other most
/// straightly, within 45 degrees, belong to one line. Deterministic, linear time but for forks.
std::vector<CrestLine> crest_lines(const CrestGraph& graph);

/// Drops the pieces that are marked; points stay.
void drop_pieces(CrestGraph& graph, const std::vector<bool>& is_dropped);

/// Drops twigs: chains from a fork to a loose end that are shorter than `share` of the
/// neighbourhood's radius, and loops shorter than twice that. Repeats until there are none.
void drop_twigs(CrestGraph& graph, double share);

/// Unit direction in which a line leaves its end (0 first, 1 last), outwards, over `reach`.
Vec3 end_direction(const CrestGraph& graph, const CrestLine& line, int end, double reach);

double length_of(const CrestGraph& graph, const CrestLine& line);

}  // namespace fcn
