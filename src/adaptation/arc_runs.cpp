// What is left of an arc when segments of it have been dropped: its runs of kept segments, each an
// arc of its own. A closed arc that meets no other is turned first, so that the run through its
// start stays in one piece.
#include "adaptation/arc_runs.h"

#include <algorithm>

namespace fcn {
namespace {

/// New arc from segments [first, end) of an arc's chain.
void add_run(WorkingNetwork& network, const WorkingArc& arc, int first, int end,
             bool keeps_chains) {
    const int from = arc.chain[first], to = arc.chain[end];
    WorkingArc run;
    run.points.assign(arc.points.begin() + from, arc.points.begin() + to + 1);
    run.sharpness.assign(arc.sharpness.begin() + from, arc.sharpness.begin() + to + 1);
    run.crease.assign(arc.crease.begin() + from, arc.crease.begin() + to + 1);
    run.origins.assign(arc.origins.begin() + from, arc.origins.begin() + to);
    run.is_pinned = arc.is_pinned;
    run.nodes[0] = first == 0 ? arc.nodes[0] : network.add_node(run.points.front());
    run.nodes[1] = end == arc.segment_count() ? arc.nodes[1] : network.add_node(run.points.back());
    if (keeps_chains) {
        for (int k = first; k <= end; ++k) run.chain.push_back(arc.chain[k] - from);
        if (arc.long_segment >= first && arc.long_segment < end) {
            run.long_segment = arc.long_segment - first;
        }
        if (!arc.orbit_classes.empty()) {
            run.orbit_classes.assign(arc.orbit_classes.begin() + first,
                                     arc.orbit_classes.begin() + end);
        }
    }
    network.arcs.push_back(std::move(run));
}

void add_runs(WorkingNetwork& network, const WorkingArc& arc, const std::vector<bool>& kept,
              bool keeps_chains) {
    const int count = static_cast<int>(kept.size());
    for (int k = 0; k < count;) {
        int end = k;
        while (end < count && kept[end] == kept[k]) ++end;
        if (kept[k]) add_run(network, arc, k, end, keeps_chains);
        k = end;
    }
}

/// Turns a closed arc, and its flags with it, so that it starts at its first dropped segment.
void turn_to_gap(WorkingNetwork& network, int a, std::vector<bool>& kept) {
    WorkingArc& arc = network.arcs[a];
    const int count = static_cast<int>(kept.size());
    const int gap = static_cast<int>(std::ranges::find(kept, false) - kept.begin());
    const int shift = arc.chain[gap];
    const int last = static_cast<int>(arc.points.size()) - 1;
    network.rotate_closed(a, shift);
    std::vector<int> chain;
    for (int k = gap; k < count; ++k) chain.push_back(arc.chain[k] - shift);
    for (int k = 0; k <= gap; ++k) chain.push_back(arc.chain[k] + last - shift);
    arc.chain = std::move(chain);
    if (arc.long_segment >= 0) arc.long_segment = (arc.long_segment - gap + count) % count;
    if (!arc.orbit_classes.empty()) {
        std::ranges::rotate(arc.orbit_classes, arc.orbit_classes.begin() + gap);
    }
    std::rotate(kept.begin(), kept.begin() + gap, kept.end());
}

bool meets_others(const WorkingNetwork& network, int a) {
    const int node = network.arcs[a].nodes[0];
    for (std::size_t b = 0; b < network.arcs.size(); ++b) {
        const WorkingArc& other = network.arcs[b];
        if (!other.is_alive || static_cast<int>(b) == a) continue;
        if (other.nodes[0] == node || other.nodes[1] == node) return true;
    }
    return false;
}

}  // namespace

void chain_small_loop(WorkingArc& arc) {
    const double length = arc.length();
    const int last = static_cast<int>(arc.points.size()) - 1;
    arc.chain = {0};
    double along = 0;
    for (int k = 1; k < last && arc.chain.size() < 3; ++k) {
        along += (arc.points[k] - arc.points[k - 1]).norm();
        const bool is_due = along >= length * static_cast<double>(arc.chain.size()) / 3;
        const bool is_last_chance = last - k <= 3 - static_cast<int>(arc.chain.size());
        if (is_due || is_last_chance) arc.chain.push_back(k);
    }
    arc.chain.push_back(last);
}

void keep_runs(WorkingNetwork& network, int a, const std::vector<bool>& kept, bool keeps_chains) {
    const bool passes_start = network.arcs[a].is_closed() && kept.front() && kept.back();
    std::vector<bool> turned = kept;
    if (passes_start && !meets_others(network, a)) turn_to_gap(network, a, turned);
    const WorkingArc arc = std::move(network.arcs[a]);
    network.remove_arc(a);
    add_runs(network, arc, turned, keeps_chains);
}

void remove_dangling(WorkingNetwork& network, std::vector<int>& given_up) {
    for (bool is_removing = true; is_removing;) {
        is_removing = false;
        const auto stars = network.stars();
        std::vector<int> rest;
        for (int a : given_up) {
            const WorkingArc& arc = network.arcs[a];
            if (stars[arc.nodes[0]].size() < 2 || stars[arc.nodes[1]].size() < 2) {
                network.remove_arc(a);
                is_removing = true;
            } else {
                rest.push_back(a);
            }
        }
        given_up = std::move(rest);
    }
}

}  // namespace fcn
