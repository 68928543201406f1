// Which annealing pays depends on the problem and changes as the search goes on: sparse problems
// are finished by short chains and small windows, dense ones need chains that cool slowly, and all
// need them late. So the kinds compete as arms of a bandit with discounted gains per tick
// (Garivier & Moulines 2011 analyse such discounting); half of the rounds explore, so that a kind
// is found again once it has become worth while.
#include "labeling/chain_schedule.h"

namespace labeling {
namespace {

constexpr double kExploration = 0.5;
constexpr double kDiscount = 0.9;

}  // namespace

ChainSchedule::ChainSchedule(bool has_windows, bool is_adaptive) : is_adaptive_(is_adaptive) {
    for (std::int64_t ticks : {25, 100, 400}) kinds_.push_back({false, ticks});
    if (!has_windows) return;
    for (std::int64_t ticks : {30, 120}) kinds_.push_back({true, ticks});
}

std::size_t ChainSchedule::choose(Random& random) {
    std::size_t best = kinds_.size();
    double most = 0;
    if (is_adaptive_ && random.unit() > kExploration) {
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            const ChainKind& kind = kinds_[k];
            if (kind.cost <= 0 || kind.gain / kind.cost <= most) continue;
            most = kind.gain / kind.cost;
            best = k;
        }
    }
    if (best < kinds_.size()) return best;
    double sum = 0;
    for (const ChainKind& kind : kinds_) sum += 1.0 / static_cast<double>(kind.ticks);
    double at = random.unit() * sum;
    for (std::size_t k = 0; k + 1 < kinds_.size(); ++k) {
        at -= 1.0 / static_cast<double>(kinds_[k].ticks);
        if (at <= 0) return k;
    }
    return kinds_.size() - 1;
}

void ChainSchedule::credit(std::size_t k, double gain, double cost) {
    ChainKind& kind = kinds_[k];
    ++kind.used;
    kind.gain = kDiscount * kind.gain + gain;
    kind.cost = kDiscount * kind.cost + cost;
}

}  // namespace labeling
