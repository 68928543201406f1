// Simulated annealing (Kirkpatrick, Gelatt & Vecchi 1983) over compound moves. After a chain the
// best labeling so far and the chain's end are compared: labels in which they differ fall into
// parts that no conflict, bonus or rule joins, and each part is taken from whichever is better
// (partition crossover, Whitley, Hains & Howe 2009). So a chain loses nothing, however hot it
// starts. The threshold of a move is drawn before it is tried, which rejects most moves after one
// scan. Labels without weight and bonus (the keep-labels of extraordinary nodes) are never
// proposed: moves pull them in where a rule needs them.
#include "labeling/annealer.h"

#include <algorithm>
#include <cmath>

namespace labeling {
namespace {

// An entry of an adjacency list takes about 2 ns, a move that is rejected at once 60 ns.
constexpr std::int64_t kEntriesPerTick = 52;
constexpr std::int64_t kEntriesPerMove = 34;
constexpr std::int64_t kEntriesPerWorth = 15;
constexpr int kMovesPerCheck = 256;
constexpr std::int64_t kTicksPerPoll = 20000;
constexpr std::uint32_t kMovesPerRun = 16;  ///< one insertion in so many is a run
constexpr std::uint32_t kLongestRun = 8;
constexpr double kWorthExponent = 0.5, kLeastWorth = 0.03, kMostWorth = 30;

}  // namespace

Annealer::Annealer(const SearchModel& model, const Solution& start, std::uint64_t seed,
                   PassGuard guard)
    : model_(model),
      random_(seed),
      state_(model, start.labels, guard),
      moves_(model, state_, random_),
      parts_(model.problem(), model.rows()),
      proposals_(model.proposals()),
      is_allowed_(model.label_count(), 1),
      best_(start) {
    for (Label i : proposals_) is_allowed_[i] = 0;
    worths_.reserve(model.label_count());
    for (Label i = 0; i < model.label_count(); ++i) {
        auto worth = static_cast<double>(model.problem().weight(i));
        for (const auto& b : model.problem().bonuses_of(i)) {
            worth += 0.5 * static_cast<double>(b.value);
        }
        const double relative = std::clamp(worth / model.scale(), kLeastWorth, kMostWorth);
        worths_.push_back(static_cast<float>(std::pow(relative, kWorthExponent)));
        guard.step(kEntriesPerWorth);
    }
    for (std::size_t k = 0; k < log_table_.size(); ++k) {
        const auto size = static_cast<double>(log_table_.size());
        log_table_[k] = static_cast<float>(std::log((static_cast<double>(k) + 0.5) / size));
    }
}

void Annealer::allow(std::int64_t ticks, std::function<bool()> poll) {
    limit_ = work_ + ticks;
    poll_ = std::move(poll);
    next_poll_ = work_;
    charge(0);
}

void Annealer::charge(std::int64_t entries) {
    work_ += 1 + entries / kEntriesPerTick;
    if (work_ < next_poll_) return;
    next_poll_ = work_ + kTicksPerPoll;
    if (poll_ && poll_()) is_stopped_ = true;
}

void Annealer::run_chain(const Chain& chain) {
    if (is_stopped() || proposals_.empty()) return;
    anneal(chain);
    descend();
    recombine();
    ++statistics.chains;
}

void Annealer::run_window(std::span<const Label> labels, const Chain& chain) {
    if (is_stopped() || labels.empty()) return;
    for (Label i : labels) is_allowed_[i] = 1;
    moves_.restrict_to(&is_allowed_);
    proposals_ = labels;
    anneal(chain);
    descend();
    proposals_ = model_.proposals();
    moves_.restrict_to(nullptr);
    for (Label i : labels) is_allowed_[i] = model_.is_proposed(i) ? 0 : 1;
    recombine();
    ++statistics.windows;
}

void Annealer::run_random_window(std::size_t size, const Chain& chain) {
    if (is_stopped() || proposals_.empty()) return;
    collect_window(std::min(size, proposals_.size()));
    run_window(window_, chain);
}

void Annealer::restart(const Chain& chain) {
    if (is_stopped() || proposals_.empty()) return;
    is_recording_ = false;
    anneal(chain);
    descend();
    is_recording_ = true;
    best_.value = state_.value();
    best_.labels.assign(state_.labels().begin(), state_.labels().end());
    since_best_.clear();
    is_tracking_ = true;
    charge(model_.label_count());
}

/// Breadth-first from a random label over bonuses and conflicts.
void Annealer::collect_window(std::size_t size) {
    window_.clear();
    auto add = [&](Label i) {
        if (is_allowed_[i] != 0 || window_.size() >= size) return;
        is_allowed_[i] = 1;
        window_.push_back(i);
    };
    add(proposals_[random_.below(static_cast<std::uint32_t>(proposals_.size()))]);
    for (std::size_t k = 0; k < window_.size() && window_.size() < size; ++k) {
        for (const auto& b : model_.problem().bonuses_of(window_[k])) add(b.label);
        for (Label j : model_.problem().conflicts_of(window_[k])) add(j);
    }
}

void Annealer::anneal(const Chain& chain) {
    const std::int64_t first = work_;
    const std::int64_t ticks = std::max<std::int64_t>(1, std::min(chain.ticks, limit_ - work_));
    const double ratio = std::log(chain.coldest / chain.hottest);
    while (!is_stopped()) {
        const double progress = static_cast<double>(work_ - first) / static_cast<double>(ticks);
        if (progress >= 1.0) return;
        const double temperature = chain.hottest * model_.scale() * std::exp(ratio * progress);
        const std::int64_t before = state_.work();
        for (int k = 0; k < kMovesPerCheck; ++k) propose(temperature, chain.is_by_worth);
        charge(state_.work() - before + kEntriesPerMove * kMovesPerCheck);
    }
}

void Annealer::propose(double temperature, bool is_by_worth) {
    ++statistics.moves;
    const std::uint64_t bits = random_.next();
    const Label i = proposals_[((bits & 0xffffffffU) * proposals_.size()) >> 32];
    const double heat = is_by_worth ? temperature * worths_[i] : temperature;
    const auto threshold = static_cast<Value>(heat * log_table_[bits >> 52]);
    bool is_done = false;
    if (!state_.is_on(i) && ((bits >> 32) & 0xfffffU) % kMovesPerRun == 0) {
        const int length = 2 + static_cast<int>(random_.below(kLongestRun - 1));
        is_done = moves_.insert_run(i, length, threshold);
    } else {
        is_done = moves_.flip(i, threshold);
    }
    if (is_done) accept();
}

void Annealer::accept() {
    ++statistics.accepted;
    if (is_tracking_) {
        since_best_.insert(since_best_.end(), state_.log().begin(), state_.log().end());
        if (since_best_.size() > best_.labels.size()) {
            is_tracking_ = false;
            since_best_.clear();
        }
    }
    state_.commit();
    if (is_recording_ && state_.value() > best_.value) keep();
}

/// The current labeling becomes the best.
void Annealer::keep() {
    best_.value = state_.value();
    if (is_tracking_) {
        for (Label i : since_best_) best_.labels[i] = state_.is_on(i) ? 1 : 0;
    } else {
        best_.labels.assign(state_.labels().begin(), state_.labels().end());
    }
    since_best_.clear();
    is_tracking_ = true;
}

/// Improving moves until a pass finds none.
void Annealer::descend() {
    for (bool is_better = true; is_better && !is_stopped();) {
        is_better = false;
        const std::int64_t before = state_.work();
        for (Label i : proposals_) {
            if (!moves_.flip(i, 1)) continue;
            accept();
            is_better = true;
        }
        const auto moves = static_cast<std::int64_t>(proposals_.size());
        charge(state_.work() - before + kEntriesPerMove * moves);
    }
}

/// Takes over the parts of the current labeling that beat the best, then continues from it.
void Annealer::recombine() {
    const std::int64_t before = state_.work();
    if (!is_tracking_) {
        since_best_.clear();
        for (Label i = 0; i < model_.label_count(); ++i) {
            if (state_.is_on(i) != (best_.labels[i] != 0)) since_best_.push_back(i);
        }
        charge(model_.label_count() / 4);
    }
    for (Label i : since_best_) {
        if (state_.is_on(i) != (best_.labels[i] != 0)) changes_.emplace_back(i, state_.is_on(i));
    }
    const auto looked_at = static_cast<std::int64_t>(since_best_.size());
    for (const auto& part : parts_.split(since_best_, best_.labels, state_.labels())) {
        const Value value = state_.value();
        for (Label i : part) state_.flip(i);
        // Now the part is as in the best; the chain's version returns if it was better.
        if (state_.value() < value) {
            state_.roll_back();
        } else {
            state_.commit();
        }
    }
    if (state_.value() > best_.value) {
        best_.value = state_.value();
        for (Label i : since_best_) best_.labels[i] = state_.is_on(i) ? 1 : 0;
    }
    // Every part that is no better was put back: the two labelings are equal now.
    since_best_.clear();
    is_tracking_ = true;
    charge(2 * (state_.work() - before) + looked_at);
}

void Annealer::merge(const Solution& other) {
    // The current labeling, which is the best, plays the chain's end.
    best_ = other;
    is_tracking_ = false;
    recombine();
    changes_.clear();
}

void Annealer::adopt(const Solution& other) {
    const std::int64_t before = state_.work();
    for (Label i = 0; i < model_.label_count(); ++i) {
        if (state_.is_on(i) != (other.labels[i] != 0)) state_.flip(i);
    }
    state_.commit();
    best_ = other;
    since_best_.clear();
    is_tracking_ = true;
    charge(state_.work() - before + model_.label_count() / 4);
}

}  // namespace labeling
