// The tree of branch and cut. A lane dives from a node into the child that looks better and, where
// that ends, continues with the node of the best bound that it has. Lanes work side by side in
// rounds of a fixed number of ticks; between rounds they hand in their open nodes, solutions and
// pseudo costs and get the best open nodes dealt out anew. What a lane does in a round depends on
// what it was given and on its own LP alone, and lanes are merged in their order: so the tree, and
// every byte of the answer, is the same on any number of threads. Rounds in which a lane has
// nothing to do last one node, so that the others split off work for it soon.
#include "labeling/cut_tree.h"

#include <algorithm>
#include <numeric>
#include <queue>

#include "labeling/branching.h"
#include "labeling/side_by_side.h"

namespace labeling {
namespace {

constexpr std::size_t kMostOpenNodes = 20000;
constexpr std::size_t kSpareNodes = 3;  ///< dealt to a lane beside the one it begins with
constexpr std::int64_t kNoIterationLimit = std::int64_t{1} << 40;
constexpr int kNodeRounds = 1;
constexpr std::int64_t kNodesPerPolish = 16;

struct Node {
    std::vector<Decision> decisions;
    Value bound = 0;
    std::shared_ptr<const Relaxation::SavedBasis> basis;
    std::int64_t number = 0;
};

struct WorseNode {
    bool operator()(const Node& a, const Node& b) const {
        return a.bound != b.bound ? a.bound < b.bound : a.number < b.number;
    }
};

class OpenNodes {
public:
    bool empty() const { return queue_.empty(); }
    std::size_t size() const { return queue_.size(); }
    Value bound() const { return queue_.empty() ? kNoValue : queue_.top().bound; }
    void push(Node node) { queue_.push(std::move(node)); }
    Node pop() {
        Node node = queue_.top();
        queue_.pop();
        return node;
    }
    /// Best first.
    std::vector<Node> take_all() {
        std::vector<Node> nodes;
        while (!queue_.empty()) nodes.push_back(pop());
        return nodes;
    }
    /// Drops what is prunable; false: nothing is left.
    bool prune(Value best) {
        if (bound() <= best) queue_ = {};
        return !queue_.empty();
    }

private:
    std::priority_queue<Node, std::vector<Node>, WorseNode> queue_;
};

/// One dive at a time, with what has split off from it.
class Diver {
public:
    Diver(CutLane& lane, const Brancher& brancher, std::size_t root_size)
        : lane_(lane), brancher_(brancher), root_size_(root_size) {
        row_count_ = lane.relaxation.row_count();
    }
    Diver(std::unique_ptr<CutLane> own, const Brancher& brancher, std::size_t root_size)
        : Diver(*own, brancher, root_size) {
        own_ = std::move(own);
    }

    bool is_diving() const { return current_.has_value(); }
    bool has_work() const { return is_diving() || !open.empty(); }
    Value bound() const { return std::max(current_ ? current_->bound : kNoValue, open.bound()); }
    /// The node where the LP stands already.
    void begin_here(Node node) { current_ = std::move(node); }

    /// One node, and more while less than `ticks` are spent.
    void run(std::int64_t ticks) {
        const std::int64_t first = lane_.control().work();
        do {
            if (!current_ && !continue_elsewhere()) return;
            ++lane_.statistics.nodes;
            const Outcome outcome = process(*current_);
            if (outcome == Outcome::Stopped) return;
            if (outcome == Outcome::Pruned || !branch()) current_.reset();
        } while (!lane_.control().should_stop() && lane_.control().work() - first < ticks);
    }

    CutLane& lane() { return lane_; }
    Brancher& brancher() { return brancher_; }
    OpenNodes open;  ///< dealt or split off in this round

private:
    enum class Outcome { Pruned, Branch, Stopped };

    bool continue_elsewhere() {
        while (open.prune(lane_.best_value)) {
            current_ = open.pop();
            if (load(*current_)) return true;
        }
        current_.reset();
        return false;
    }

    /// False when the node turns out contradictory.
    bool load(const Node& node) {
        lane_.state.undo(root_size_);
        for (const Decision& d : node.decisions) {
            if (!lane_.state.assign(d.label, d.value)) return false;
        }
        if (node.basis) lane_.relaxation.restore_basis(*node.basis);
        return true;
    }

    Outcome process(Node& node) {
        for (int round = 0;; ++round) {
            const auto lp = lane_.solve(kNoIterationLimit);
            node.bound = std::min(node.bound, lane_.relaxation.bound());
            if (lane_.is_prunable(node.bound)) return Outcome::Pruned;
            if (lane_.control().should_stop()) return Outcome::Stopped;
            if (lane_.propagator.free_count() == 0) {
                lane_.accept_leaf();
                return Outcome::Pruned;
            }
            if (lp == LpEngine::Outcome::Failed || lp == LpEngine::Outcome::Infeasible) {
                return Outcome::Branch;
            }
            const std::size_t before = lane_.state.size();
            if (!lane_.fix_by_bounds()) return Outcome::Pruned;
            if (lane_.add_violated_rules() > 0) continue;
            if (lane_.state.size() > before + 4 && round < 10) continue;
            if (lane_.accept_if_integral() && lane_.is_prunable(node.bound)) return Outcome::Pruned;
            if (lane_.statistics.nodes % kNodesPerPolish == 1 && round == 0) lane_.polish();
            if (round >= kNodeRounds || lane_.add_cliques({0.01, 200, 200}) == 0) break;
        }
        if (lane_.relaxation.row_count() > row_count_ + row_count_ / 2) {
            constexpr int kIdleSolves = 10;
            lane_.relaxation.drop_idle_rows(kIdleSolves);
            row_count_ = std::max(row_count_, lane_.relaxation.row_count());
        }
        return Outcome::Branch;
    }

    /// The better child becomes current, the other one open. False: there is none to go to
    /// directly.
    bool branch() {
        Node& node = *current_;
        const auto basis =
            std::make_shared<const Relaxation::SavedBasis>(lane_.relaxation.save_basis());
        const std::size_t size = lane_.state.size();
        Brancher::Choice choice = brancher_.choose(lane_, node.bound, *basis);
        if (choice.is_settled) return false;
        node.decisions.insert(node.decisions.end(), choice.decided.begin(), choice.decided.end());
        if (choice.label < 0) return true;  // the same node again
        Node other = node;
        other.decisions.push_back({choice.label, !choice.first});
        other.basis = basis;
        other.number = ++node_number_;
        other.bound = std::min(node.bound, choice.bounds[choice.first ? 0 : 1]);
        if (!lane_.is_prunable(other.bound)) open.push(std::move(other));
        node.decisions.push_back({choice.label, choice.first});
        node.bound = std::min(node.bound, choice.bounds[choice.first ? 1 : 0]);
        lane_.state.undo(size);
        return !lane_.is_prunable(node.bound) && lane_.state.assign(choice.label, choice.first);
    }

    std::unique_ptr<CutLane> own_;  ///< empty for the lane that came from the root
    CutLane& lane_;
    Brancher brancher_;
    const std::size_t root_size_;
    std::optional<Node> current_;
    std::int32_t row_count_ = 0;
    std::int64_t node_number_ = 0;
};

class CutTree {
public:
    CutTree(CutLane& root, Value root_bound, const CutTreeOptions& options)
        : root_(root),
          control_(root.control()),
          options_(options),
          root_bound_(root_bound),
          root_size_(root.state.size()),
          best_value_(root.best_value) {
        divers_.push_back(std::make_unique<Diver>(root, Brancher(root.shared.problem), root_size_));
        Node node;
        node.bound = root_bound;
        divers_[0]->begin_here(std::move(node));
    }

    Value run() {
        while (true) {
            const std::size_t busy = deal();
            if (busy == 0) return finish(bound_of_dropped_);
            run_round(busy);
            merge();
            report();
            if (control_.should_stop()) return finish(open_bound());
            if (!options_.improve) continue;
            take(options_.improve());
            report();
        }
    }

private:
    /// Hands out the best open nodes; returns how many divers, the first ones, may have work.
    std::size_t deal() {
        const auto lanes = static_cast<std::size_t>(options_.lanes);
        for (std::size_t k = 0; k < lanes && open_.prune(best_value_); ++k) {
            if (k == divers_.size()) add_diver();
            if (!divers_[k]->is_diving()) divers_[k]->open.push(open_.pop());
        }
        for (std::size_t turn = 0; turn < kSpareNodes; ++turn) {
            for (const auto& diver : divers_) {
                if (open_.prune(best_value_)) diver->open.push(open_.pop());
            }
        }
        std::size_t busy = 0;
        for (const auto& diver : divers_) busy += diver->has_work() ? 1 : 0;
        return busy;
    }

    void add_diver() {
        const auto number = static_cast<std::uint32_t>(divers_.size());
        auto lane = std::make_unique<CutLane>(root_, root_size_, number);
        divers_.push_back(
            std::make_unique<Diver>(std::move(lane), divers_[0]->brancher(), root_size_));
    }

    void run_round(std::size_t busy) {
        const bool all_busy = busy == static_cast<std::size_t>(options_.lanes);
        const std::int64_t ticks = all_busy ? options_.round : 0;
        const std::int64_t share = control_.work_left() / static_cast<std::int64_t>(busy) + 1;
        std::vector<Diver*> working;
        for (const auto& diver : divers_) {
            if (diver->has_work()) working.push_back(diver.get());
        }
        std::vector<std::int64_t> work(working.size(), 0);
        const int threads = working.size() > 1 ? 1 : options_.threads;
        run_side_by_side(working.size(), options_.threads, control_,
                         [&](std::size_t k, const StopQuestion& is_stopped) {
                             RunControl control(share, is_stopped);
                             working[k]->lane().use(control, threads);
                             working[k]->run(ticks);
                             work[k] = control.work();
                         });
        root_.use(control_, options_.threads);
        const std::int64_t sum = std::accumulate(work.begin(), work.end(), std::int64_t{0});
        root_.statistics.tree_work += sum;
        root_.statistics.tree_path += *std::max_element(work.begin(), work.end());
        control_.spend(sum);
    }

    void merge() {
        std::vector<std::vector<Brancher::Lesson>> lessons;
        for (const auto& diver : divers_) {
            if (auto solution = diver->lane().take_solution()) take(std::move(solution));
            for (Node& node : diver->open.take_all()) {
                node.number = ++node_number_;
                open_.push(std::move(node));
            }
            lessons.push_back(diver->brancher().take_lessons());
        }
        for (std::size_t k = 0; k < divers_.size(); ++k) {
            divers_[k]->lane().best_value = best_value_;
            for (std::size_t other = 0; other < lessons.size(); ++other) {
                if (other == k) continue;
                for (const auto& lesson : lessons[other]) divers_[k]->brancher().learn(lesson);
            }
        }
        if (open_.size() > kMostOpenNodes) drop_worst();
    }

    void take(std::optional<Solution> solution) {
        if (!solution || solution->value <= best_value_) return;
        best_value_ = solution->value;
        found_ = std::move(solution);
        for (const auto& diver : divers_) diver->lane().best_value = best_value_;
    }

    /// Memory bound: forgets the nodes of the lowest bounds but remembers the largest of these.
    void drop_worst() {
        std::vector<Node> nodes = open_.take_all();
        bound_of_dropped_ = std::max(bound_of_dropped_, nodes[kMostOpenNodes / 2].bound);
        nodes.resize(kMostOpenNodes / 2);
        for (Node& node : nodes) open_.push(std::move(node));
    }

    void report() {
        if (options_.report) options_.report(std::exchange(found_, std::nullopt), bound());
    }

    Value finish(Value open) {
        for (std::size_t k = 1; k < divers_.size(); ++k) {
            root_.statistics += divers_[k]->lane().statistics;
        }
        return open;
    }

    Value open_bound() const {
        Value bound = std::max(bound_of_dropped_, open_.bound());
        for (const auto& diver : divers_) bound = std::max(bound, diver->bound());
        return std::min(bound, root_bound_);
    }
    Value bound() const { return std::max(best_value_, open_bound()); }

    CutLane& root_;
    RunControl& control_;
    const CutTreeOptions& options_;
    const Value root_bound_;
    const std::size_t root_size_;
    Value best_value_;
    std::optional<Solution> found_;
    std::vector<std::unique_ptr<Diver>> divers_;
    OpenNodes open_;
    Value bound_of_dropped_ = kNoValue;
    std::int64_t node_number_ = 0;
};

}  // namespace

Value search_cut_tree(CutLane& root, Value root_bound, const CutTreeOptions& options) {
    return CutTree(root, root_bound, options).run();
}

}  // namespace labeling
