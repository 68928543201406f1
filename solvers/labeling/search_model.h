#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "labeling/pass_guard.h"
#include "labeling/problem.h"
#include "labeling/rows.h"

namespace labeling {

/// What searches read of a problem, laid out for speed and shared by all searches on it. Rows of
/// three labels of which at most two may be 1 (most rows, on dense problems) are kept as triples:
/// they cost nothing when a label is switched off, and two byte look-ups when it is switched on.
class SearchModel {
public:
    /// The two other labels of a triple.
    struct Pair {
        Label first = 0;
        Label second = 0;
    };

    /// Both must outlive the model. May stop in the guard.
    SearchModel(const LabelingProblem& problem, const RowSystem& rows, PassGuard guard = {});

    const LabelingProblem& problem() const { return problem_; }
    const RowSystem& rows() const { return rows_; }
    Label label_count() const { return problem_.label_count(); }

    std::span<const Pair> triples(Label i) const {
        return {pairs_.data() + pair_begin_[i], pair_begin_[i + 1] - pair_begin_[i]};
    }
    /// Rows that contain the label and are no triples, ascending.
    std::span<const RowSystem::Use> uses(Label i) const {
        return {uses_.data() + use_begin_[i], use_begin_[i + 1] - use_begin_[i]};
    }
    /// Labels whose flips may be worth something: the others are called for by rules alone.
    std::span<const Label> proposals() const { return proposals_; }
    bool is_proposed(Label i) const {
        return problem_.weight(i) > 0 || !problem_.bonuses_of(i).empty();
    }
    /// Median of weight plus half the bonuses over the proposals; at least 1.
    double scale() const { return scale_; }

private:
    void set_scale();

    const LabelingProblem& problem_;
    const RowSystem& rows_;
    std::vector<std::uint32_t> pair_begin_, use_begin_;
    std::vector<Pair> pairs_;
    std::vector<RowSystem::Use> uses_;
    std::vector<Label> proposals_;
    double scale_ = 1;
};

}  // namespace labeling
