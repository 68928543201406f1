#pragma once

#include <cstdint>
#include <string>

#include "labeling/problem.h"

namespace labeling_test {

/// A problem of at most 12 labels: random ones with rules of every kind, frustrated ones, bundles
/// of curves and every family of the generators, some of them with duplicates, renamed labels and
/// values up to the largest that are allowed.
labeling::LabelingProblem fuzz_problem(std::uint64_t seed);

/// Frustrated and random problems and bundles of 14 to 60 labels, where cuts and branching matter.
labeling::LabelingProblem larger_fuzz_problem(std::uint64_t seed);

enum class FuzzSize { Small, Larger };

/// Solves the seed's problem with options drawn from the seed (techniques on and off, limits, an
/// injected clock, a stop request, gap, threads, warm starts that are best, partial or impossible)
/// and checks solution, status and every point of the trace against the optimum, which comes from
/// enumeration, for larger problems from the depth-first tree with every technique off; one run in
/// eight is repeated on two threads and must give the same. Empty when all is well; otherwise what
/// is wrong, the options and the shrunk problem.
std::string fuzz_failure(const std::string& solver, std::uint64_t seed,
                         FuzzSize size = FuzzSize::Small);

}  // namespace labeling_test
