#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "labeling/compound_move.h"
#include "labeling/difference_parts.h"
#include "labeling/random.h"
#include "labeling/search_model.h"
#include "labeling/search_state.h"
#include "labeling/solution.h"

namespace labeling {

/// Temperatures are in units of SearchModel::scale().
struct Chain {
    double hottest = 1.2;
    double coldest = 0.2;
    std::int64_t ticks = 0;
    bool is_by_worth = false;  ///< hotter where labels are worth more
};

struct AnnealerStatistics {
    std::int64_t moves = 0, accepted = 0, chains = 0, windows = 0;
};

/// Simulated annealing over compound moves with a best labeling that it never loses: after each
/// chain the parts in which chain and best differ are taken from whichever is better, and the
/// search continues from there. Memory: some 30 bytes per label and 8 per row.
class Annealer {
public:
    /// `start` must be feasible. The model must outlive the annealer.
    /// May stop in the guard.
    Annealer(const SearchModel& model, const Solution& start, std::uint64_t seed,
             PassGuard guard = {});

    /// Until the next call work stops after `ticks`, or soon after `poll` (may be empty) is true.
    void allow(std::int64_t ticks, std::function<bool()> poll);
    std::int64_t work() const { return work_; }
    bool is_stopped() const { return is_stopped_ || work_ >= limit_; }

    void run_chain(const Chain& chain);
    /// A chain that may change only `labels` and what only rules call for.
    void run_window(std::span<const Label> labels, const Chain& chain);
    /// The same on some `size` connected labels around a random one.
    void run_random_window(std::size_t size, const Chain& chain);
    /// The end of the chain becomes the best, whatever it is worth.
    void restart(const Chain& chain);

    /// Takes the parts in which the other labeling is better.
    void merge(const Solution& other);
    void adopt(const Solution& other);
    const Solution& best() const { return best_; }
    double unit() { return random_.unit(); }

    /// Labels in which ends of chains differed from the best since the last call, with the values
    /// they had there. Later chains come later.
    std::vector<std::pair<Label, std::uint8_t>> take_changes() {
        return std::exchange(changes_, {});
    }

    AnnealerStatistics statistics;

private:
    void anneal(const Chain& chain);
    void propose(double temperature, bool is_by_worth);
    void descend();
    void recombine();
    void accept();
    void keep();
    void collect_window(std::size_t size);
    void charge(std::int64_t entries);

    const SearchModel& model_;
    Random random_;
    SearchState state_;
    CompoundMoves moves_;
    DifferenceParts parts_;
    std::span<const Label> proposals_;  ///< labels that moves start from
    std::vector<Label> window_;
    std::vector<std::uint8_t> is_allowed_;  ///< in the window; labels of rules alone always are
    Solution best_;
    std::vector<Label> since_best_;  ///< flips from the best to the current labeling
    std::vector<std::pair<Label, std::uint8_t>> changes_;
    bool is_tracking_ = true;    ///< since_best_ is complete
    bool is_recording_ = true;   ///< better labelings become the best
    std::vector<float> worths_;  ///< per label, factor of the temperature
    std::array<float, 4096> log_table_{};
    std::int64_t work_ = 0, limit_ = 0, next_poll_ = 0;
    std::function<bool()> poll_;
    bool is_stopped_ = false;
};

}  // namespace labeling
