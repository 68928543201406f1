// Exact bounds from a floating-point LP. For any multipliers y >= 0,
//   max { c x : A x <= b, l <= x <= u }  <=  y b + sum_j max over x_j in [l_j, u_j] of (c - y A)_j
//   x_j,
// so we round the solver's multipliers to multiples of 2^-36 and evaluate the right side in 128-bit
// integers (Neumaier & Shcherbina 2004 do the same with interval arithmetic). The objective handed
// to the solver is divided by a power of two, so nothing is lost there. Infeasibility is believed
// only when the solver's ray proves it the same way.
#include "labeling/relaxation.h"

#include <algorithm>
#include <cmath>

#include "labeling/tree_search.h"

namespace labeling {
namespace {

constexpr Value kHugeBound = Value{1} << 60;
constexpr int kIdBits = 27;

Value floor_shift(Int128 number, int shift) { return static_cast<Value>(number >> shift); }

}  // namespace

std::uint64_t hash_of(const Cut& cut) {
    std::uint64_t h = static_cast<std::uint64_t>(cut.right_hand_side) * 0x9e3779b97f4a7c15ULL;
    for (const Cut::Entry& e : cut.entries) {
        h ^= (static_cast<std::uint64_t>(e.column) << 32) ^
             static_cast<std::uint32_t>(e.coefficient);
        h *= 0xbf58476d1ce4e5b9ULL;
        h ^= h >> 29;
    }
    return h;
}

Relaxation::Relaxation(const LabelingProblem& problem, const LpFactory& factory)
    : engine_(factory()),
      bonuses_(problem.bonuses().begin(), problem.bonuses().end()),
      objective_(problem.weights().begin(), problem.weights().end()) {
    for (const Bonus& b : problem.bonuses()) objective_.push_back(b.value);
    lower_.assign(objective_.size(), 0);
    upper_.assign(objective_.size(), 1);
    choose_scale();
    reset_engine();
    bound_ = kHugeBound;
}

void Relaxation::choose_scale() {
    scale_ = 1;
    Value largest = 1;
    for (Value c : objective_) largest = std::max(largest, std::abs(c));
    while (static_cast<double>(largest) / scale_ > 2048) scale_ *= 2;
    while (static_cast<double>(largest) / scale_ < 512) scale_ /= 2;
}

void Relaxation::leave_out(std::span<const std::int32_t> bonuses) {
    if (bonuses.empty()) return;
    const auto labels = static_cast<std::int32_t>(objective_.size() - bonuses_.size());
    left_out_.assign(objective_.size(), 0);
    for (const std::int32_t k : bonuses) {
        const Bonus& b = bonuses_[k];
        left_out_[labels + k] = 1;
        objective_[labels + k] = 0;
        objective_[b.first] += b.value / 2;
        objective_[b.second] += b.value - b.value / 2;
        lower_[labels + k] = upper_[labels + k] = 0;
    }
    choose_scale();
    reset_engine();
}

void Relaxation::bring_in(std::int32_t bonus) {
    const auto column = static_cast<std::int32_t>(objective_.size() - bonuses_.size()) + bonus;
    if (!is_left_out(column)) return;
    const Bonus& b = bonuses_[bonus];
    left_out_[column] = 0;
    objective_[column] = b.value;
    objective_[b.first] -= b.value / 2;
    objective_[b.second] -= b.value - b.value / 2;
    for (const std::int32_t c : {column, b.first, b.second}) {
        engine_->set_objective(c, static_cast<double>(objective_[c]) / scale_);
    }
    unfix(column);
}

double Relaxation::excess_of_left_out(std::int32_t bonus) const {
    const Bonus& b = bonuses_[bonus];
    const auto x = engine_->columns();
    return static_cast<double>(b.value) / 2 * std::abs(x[b.first] - x[b.second]);
}

Relaxation::Relaxation(const Relaxation& other, const LpFactory& factory, std::uint32_t range)
    : engine_(factory()),
      bonuses_(other.bonuses_),
      left_out_(other.left_out_),
      objective_(other.objective_),
      lower_(other.lower_),
      upper_(other.upper_),
      rows_(other.rows_),
      aside_(other.aside_),
      row_hashes_(other.row_hashes_),
      bound_(kHugeBound),
      scale_(other.scale_),
      next_id_(std::max(other.next_id_, range << kIdBits)),
      drops_tight_rows_(other.drops_tight_rows_) {
    reset_engine();
    for (const Row& row : rows_) pass_to_engine(row);
}

void Relaxation::reset_engine() {
    std::vector<double> objective;
    for (Value c : objective_) objective.push_back(static_cast<double>(c) / scale_);
    const std::vector<double> lower(lower_.begin(), lower_.end());
    const std::vector<double> upper(upper_.begin(), upper_.end());
    engine_->reset(objective, lower, upper);
}

bool Relaxation::add(Cut cut) {
    // With a coefficient above 0, as every separator gives them, the rest stays valid.
    std::erase_if(cut.entries, [this](const Cut::Entry& e) {
        return e.coefficient > 0 && is_left_out(e.column);
    });
    const std::uint64_t hash = hash_of(cut);
    if (row_hashes_[hash]++ > 0) {
        // Equal hashes of different rows cost a cut, never correctness.
        --row_hashes_[hash];
        return false;
    }
    Row row;
    row.cut = std::move(cut);
    row.id = next_id_++;
    row.hash = hash;
    insert(std::move(row));
    return true;
}

void Relaxation::insert(Row row) {
    std::int32_t largest = 1;
    for (const Cut::Entry& e : row.cut.entries) {
        largest = std::max(largest, std::abs(e.coefficient));
    }
    row.scale = 1;
    row.largest = std::max(static_cast<double>(largest),
                           std::abs(static_cast<double>(row.cut.right_hand_side)));
    while (row.scale * 8 < largest) row.scale *= 2;
    row.idle_age = 0;
    row.is_slack = false;
    pass_to_engine(row);
    rows_.push_back(std::move(row));
}

void Relaxation::pass_to_engine(const Row& row) {
    std::vector<LpEngine::Entry> entries;
    entries.reserve(row.cut.entries.size());
    for (const Cut::Entry& e : row.cut.entries) {
        entries.push_back({e.column, e.coefficient / row.scale});
    }
    engine_->add_row(entries, static_cast<double>(row.cut.right_hand_side) / row.scale);
}

void Relaxation::fix(std::int32_t column, bool value) {
    lower_[column] = upper_[column] = value ? 1 : 0;
    engine_->set_bounds(column, value, value);
}

void Relaxation::unfix(std::int32_t column) {
    lower_[column] = 0;
    upper_[column] = 1;
    engine_->set_bounds(column, 0, 1);
}

LpEngine::Outcome Relaxation::solve(RunControl& control, std::int64_t max_iterations) {
    constexpr std::int64_t kChunk = 1000;
    bound_ = kHugeBound;
    iterations_ = 0;
    engine_->stop_when([&control] {
        control.check();
        return control.is_over();
    });
    while (true) {
        const std::int64_t chunk = std::min(kChunk, max_iterations);
        const auto outcome = engine_->solve(chunk);
        max_iterations -= engine_->iterations();
        iterations_ += engine_->iterations();
        const std::int64_t size = row_count() + column_count();
        // Measured: starting costs by size, an iteration hardly (large problems are sparser).
        const bool must_stop = control.spend(3 * size + engine_->iterations() * (800 + size / 100));
        if (outcome == LpEngine::Outcome::Infeasible) {
            if (prove_infeasible()) {
                bound_ = kNoValue;
            }
            return outcome;
        }
        if (outcome != LpEngine::Outcome::Stopped || must_stop || max_iterations <= 0) {
            compute_bound();
            if (outcome == LpEngine::Outcome::Optimal) age_rows();
            return outcome == LpEngine::Outcome::Stopped || outcome == LpEngine::Outcome::Optimal
                       ? outcome
                       : LpEngine::Outcome::Failed;
        }
    }
}

void Relaxation::compute_bound() {
    const auto multipliers = engine_->multipliers();
    reduced_.resize(objective_.size());
    for (std::size_t c = 0; c < objective_.size(); ++c) {
        reduced_[c] = static_cast<Int128>(objective_[c]) << kShift;
    }
    scaled_bound_ = 0;
    const double factor = std::ldexp(scale_, kShift);
    for (std::size_t r = 0; r < rows_.size() && r < multipliers.size(); ++r) {
        const double y = multipliers[r] * factor / rows_[r].scale;
        // Leaving a row out keeps the bound valid; sums stay below 2^127.
        if (!(y >= 0.5) || y * rows_[r].largest > 1e33) continue;
        const auto rounded = static_cast<Int128>(y + 0.5);
        scaled_bound_ += rounded * rows_[r].cut.right_hand_side;
        for (const Cut::Entry& e : rows_[r].cut.entries) {
            reduced_[e.column] -= rounded * e.coefficient;
        }
    }
    for (std::size_t c = 0; c < objective_.size(); ++c) {
        if (lower_[c] == 1 || (upper_[c] == 1 && reduced_[c] > 0)) scaled_bound_ += reduced_[c];
    }
    constexpr Int128 kHuge = static_cast<Int128>(kHugeBound) << kShift;
    bound_ = scaled_bound_ < kHuge ? floor_shift(scaled_bound_, kShift) : kHugeBound;
}

bool Relaxation::prove_infeasible() {
    const std::vector<double> ray = engine_->infeasibility_ray();
    if (ray.size() != rows_.size()) return false;
    double largest = 0;
    for (double y : ray) largest = std::max(largest, std::abs(y));
    if (!(largest > 0)) return false;
    // The sign of a ray is a matter of convention: try both.
    for (const double sign : {1.0, -1.0}) {
        const double factor = sign * std::ldexp(1.0, 30) / largest;
        Int128 side = 0;
        std::vector<Int128> sums(objective_.size(), 0);
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            const double y = ray[r] * factor / rows_[r].scale;
            if (!(y >= 0.5) || y * rows_[r].largest > 1e33) continue;
            const auto rounded = static_cast<Int128>(y + 0.5);
            side += rounded * rows_[r].cut.right_hand_side;
            for (const Cut::Entry& e : rows_[r].cut.entries) {
                sums[e.column] += rounded * e.coefficient;
            }
        }
        for (std::size_t c = 0; c < sums.size(); ++c) {
            if (lower_[c] == 1 || (upper_[c] == 1 && sums[c] < 0)) side -= sums[c];
        }
        if (side < 0) return true;
    }
    return false;
}

Value Relaxation::bound_if(std::int32_t column, bool value) const {
    if (bound_ >= kHugeBound || bound_ == kNoValue || is_fixed(column)) return bound_;
    const Int128 reduced = reduced_[column];
    Int128 bound = scaled_bound_;
    if (value && reduced < 0) bound += reduced;
    if (!value && reduced > 0) bound -= reduced;
    return floor_shift(bound, kShift);
}

void Relaxation::age_rows() {
    const auto activities = engine_->activities();
    const auto multipliers = engine_->multipliers();
    constexpr double kIdle = 1e-9;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        const double slack =
            static_cast<double>(rows_[r].cut.right_hand_side) / rows_[r].scale - activities[r];
        rows_[r].is_slack = slack > 1e-6;
        const bool is_idle =
            drops_tight_rows_ ? std::abs(multipliers[r]) < kIdle : rows_[r].is_slack;
        rows_[r].idle_age = is_idle ? rows_[r].idle_age + 1 : 0;
    }
}

void Relaxation::drop_idle_rows(int age) {
    put_aside([age](const Row& row) { return row.idle_age >= age; });
}

void Relaxation::drop_slack_rows() {
    put_aside([](const Row& row) { return row.is_slack; });
}

template <typename Unwanted>
void Relaxation::put_aside(const Unwanted& is_unwanted) {
    std::vector<std::int32_t> dropped;
    std::size_t kept = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        if (is_unwanted(rows_[r])) {
            dropped.push_back(static_cast<std::int32_t>(r));
            aside_.push_back(std::move(rows_[r]));
            continue;
        }
        if (kept != r) rows_[kept] = std::move(rows_[r]);
        ++kept;
    }
    rows_.resize(kept);
    engine_->remove_rows(dropped);
}

std::size_t Relaxation::restore_violated_rows(std::int64_t& work) {
    const auto x = engine_->columns();
    return put_back([&](const Row& row) {
        work += static_cast<std::int64_t>(row.cut.entries.size());
        const double excess = row.cut.activity(x) - static_cast<double>(row.cut.right_hand_side);
        return excess > 1e-6 * row.scale;
    });
}

template <typename Wanted>
std::size_t Relaxation::put_back(const Wanted& is_wanted) {
    std::size_t kept = 0, restored = 0;
    for (Row& row : aside_) {
        if (is_wanted(row)) {
            insert(std::move(row));
            ++restored;
        } else {
            if (&aside_[kept] != &row) aside_[kept] = std::move(row);
            ++kept;
        }
    }
    aside_.resize(kept);
    return restored;
}

Relaxation::SavedBasis Relaxation::save_basis() const {
    SavedBasis saved;
    saved.columns = engine_->basis();
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        const std::size_t at = objective_.size() + r;
        if (at < saved.columns.size() && saved.columns[at] != LpEngine::BasisStatus::Basic) {
            saved.nonbasic_rows.push_back(rows_[r].id);
        }
    }
    std::sort(saved.nonbasic_rows.begin(), saved.nonbasic_rows.end());
    saved.columns.resize(objective_.size());
    return saved;
}

void Relaxation::restore_basis(const SavedBasis& saved) {
    const auto is_nonbasic = [&saved](const Row& row) {
        return std::binary_search(saved.nonbasic_rows.begin(), saved.nonbasic_rows.end(), row.id);
    };
    put_back(is_nonbasic);
    LpEngine::Basis basis = saved.columns;
    for (const Row& row : rows_) {
        basis.push_back(is_nonbasic(row) ? LpEngine::BasisStatus::AtUpper
                                         : LpEngine::BasisStatus::Basic);
    }
    engine_->set_basis(basis);
}

}  // namespace labeling
