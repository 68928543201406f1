// Two regions: breadth-first order over bonuses and conflicts from a random label, cut in the
// middle. More: breadth-first from as many random labels at once, which keeps borders short. A
// label with a neighbour in an earlier region stays out, so changes in different regions can always
// be combined: that is what makes the gains of searches that run side by side add up.
#include "labeling/region_splitter.h"

namespace labeling {
namespace {

constexpr std::int32_t kUnseen = -2, kOutside = -1;

}  // namespace

RegionSplitter::RegionSplitter(const SearchModel& model) : model_(model) {}

template <typename Visit>
void RegionSplitter::visit_neighbours(Label i, const Visit& visit) {
    const LabelingProblem& problem = model_.problem();
    for (const auto& b : problem.bonuses_of(i)) visit(b.label);
    for (Label j : problem.conflicts_of(i)) visit(j);
    const auto entries = static_cast<std::int64_t>(problem.conflicts_of(i).size()) + 4;
    work_ += entries;
    guard_.step(entries);
}

void RegionSplitter::order_from(Label start) {
    std::size_t k = order_.size();
    order_.push_back(start);
    region_[start] = kOutside;
    for (; k < order_.size(); ++k) {
        visit_neighbours(order_[k], [&](Label j) {
            if (region_[j] != kUnseen || !model_.is_proposed(j)) return;
            region_[j] = kOutside;
            order_.push_back(j);
        });
    }
}

/// Regions of equal size.
void RegionSplitter::cut(Random& random, std::size_t count) {
    const auto proposals = model_.proposals();
    const std::size_t first = random.below(static_cast<std::uint32_t>(proposals.size()));
    for (std::size_t k = 0; k < proposals.size(); ++k) {
        const Label i = proposals[(first + k) % proposals.size()];
        if (region_[i] == kUnseen) order_from(i);
    }
    for (std::size_t k = 0; k < order_.size(); ++k) {
        region_[order_[k]] = static_cast<std::int32_t>(k * count / order_.size());
    }
}

/// Compact regions.
void RegionSplitter::grow(Random& random, std::size_t count) {
    const auto proposals = model_.proposals();
    std::int32_t next = 0;
    auto found = [&](Label i, std::int32_t region) {
        if (region_[i] != kUnseen || !model_.is_proposed(i)) return;
        region_[i] = region;
        order_.push_back(i);
    };
    for (std::size_t k = 0; k < count; ++k) {
        found(proposals[random.below(static_cast<std::uint32_t>(proposals.size()))], next++);
    }
    std::size_t seen = 0;
    for (std::size_t k = 0; seen < proposals.size(); ++seen) {
        for (; k < order_.size(); ++k) {
            visit_neighbours(order_[k], [&](Label j) { found(j, region_[order_[k]]); });
        }
        found(proposals[seen], static_cast<std::int32_t>(static_cast<std::size_t>(next++) % count));
    }
    work_ += static_cast<std::int64_t>(order_.size());
}

std::vector<std::vector<Label>> RegionSplitter::split(Random& random, std::size_t count,
                                                      PassGuard guard) {
    guard_ = guard;
    order_.clear();
    region_.assign(model_.label_count(), kUnseen);
    if (count == 2) {
        cut(random, count);
    } else {
        grow(random, count);
    }
    std::vector<std::vector<Label>> regions(count);
    for (Label i : order_) {
        const std::int32_t own = region_[i];
        bool is_inside = true;
        auto look = [&](Label j) {
            is_inside = is_inside && !(region_[j] >= 0 && region_[j] < own);
        };
        visit_neighbours(i, look);
        for (const auto& pair : model_.triples(i)) {
            look(pair.first);
            look(pair.second);
        }
        for (const auto& use : model_.uses(i)) {
            if (!is_inside) break;
            for (const Term& t : model_.rows().terms(use.row)) look(t.label);
        }
        work_ += static_cast<std::int64_t>(model_.triples(i).size() + 4 * model_.uses(i).size());
        if (is_inside) regions[own].push_back(i);
    }
    return regions;
}

}  // namespace labeling
