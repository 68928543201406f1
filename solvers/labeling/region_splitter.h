#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "labeling/random.h"
#include "labeling/search_model.h"

namespace labeling {

/// Cuts the proposals of a model into connected regions of about equal size that share no conflict,
/// bonus or rule: labels at a border belong to none. Each split costs the whole adjacency.
class RegionSplitter {
public:
    explicit RegionSplitter(const SearchModel& model);
    /// May stop in the guard.
    std::vector<std::vector<Label>> split(Random& random, std::size_t count, PassGuard guard = {});
    /// Adjacency entries touched since the last call.
    std::int64_t take_work() { return std::exchange(work_, 0); }

private:
    template <typename Visit>
    void visit_neighbours(Label i, const Visit& visit);
    void order_from(Label start);
    void cut(Random& random, std::size_t count);
    void grow(Random& random, std::size_t count);

    const SearchModel& model_;
    std::vector<Label> order_;
    std::vector<std::int32_t> region_;
    std::int64_t work_ = 0;
    PassGuard guard_;
};

}  // namespace labeling
