#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "labeling/cut_lane.h"

namespace labeling {

struct Decision {
    Label label = 0;
    bool value = false;
};

/// Chooses the label to branch on: by strong branching, later by pseudo costs.
class Brancher {
public:
    /// What one LP of a child has taught.
    struct Lesson {
        Label label = 0;
        int value = 0;
        double gain = 0;      ///< of the bound
        double distance = 0;  ///< of the label in the relaxation from `value`
        double mass = 0;      ///< of the relaxation that the decision displaces
    };
    struct Choice {
        Label label = -1;  ///< -1: the node is settled, or `decided` has to be tried first
        bool first = false;
        Value bounds[2] = {0, 0};       ///< of the children at 0 and at 1
        bool is_settled = false;        ///< nothing better is left below the node
        std::vector<Decision> decided;  ///< made on the way: the other side is prunable
    };

    explicit Brancher(const LabelingProblem& problem);

    /// At the LP solution and basis of `lane`, which are the node's; they are restored.
    Choice choose(CutLane& lane, Value bound, const Relaxation::SavedBasis& basis);

    void learn(const Lesson& lesson);
    /// Lessons of choose() since the last call.
    std::vector<Lesson> take_lessons() { return std::exchange(lessons_, {}); }

private:
    struct PseudoCost {
        double sum[2] = {0, 0};
        int count[2] = {0, 0};
    };

    void weigh_labels();
    double displaced(Label i, bool value) const;
    double expected_gain(Label i, bool value) const;
    void strong_branch(CutLane& lane, Value bound, const Relaxation::SavedBasis& basis,
                       std::span<const std::pair<double, Label>> candidates, Choice& choice);
    Value probe(CutLane& lane, Label i, bool value, Value parent);

    const LabelingProblem& problem_;
    std::vector<PseudoCost> costs_;
    std::vector<Lesson> lessons_;
    std::vector<double> x_;       ///< of the node's relaxation
    std::vector<double> masses_;  ///< per label: value of the relaxation that goes with it
    double total_gain_[2] = {0, 0}, total_mass_[2] = {0, 0}, gain_per_mass_[2] = {1, 1};
};

}  // namespace labeling
