// labeling_solver_fuzz [--problems N] [--seed S] [--solver NAME] [--size small|larger]
// Checks the solvers (or one) on N problems each, from seed S on; prints the first failure,
// shrunk, and ends with 1.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "labeling/registry.h"
#include "labeling/solver_fuzz.h"

int main(int argc, char** argv) {
    std::uint64_t problems = 100000, seed = 1;
    std::vector<std::string> solvers = labeling::builtin_solvers().names();
    auto size = labeling_test::FuzzSize::Small;
    for (int k = 1; k < argc; k += 2) {
        const std::string_view word = argv[k];
        if (k + 1 < argc && word == "--problems") {
            problems = std::strtoull(argv[k + 1], nullptr, 10);
        } else if (k + 1 < argc && word == "--seed") {
            seed = std::strtoull(argv[k + 1], nullptr, 10);
        } else if (k + 1 < argc && word == "--solver") {
            solvers = {argv[k + 1]};
        } else if (k + 1 < argc && word == "--size") {
            size = std::string_view(argv[k + 1]) == "small" ? labeling_test::FuzzSize::Small
                                                            : labeling_test::FuzzSize::Larger;
        } else {
            std::fprintf(
                stderr,
                "usage: %s [--problems N] [--seed S] [--solver NAME] [--size small|larger]\n",
                argv[0]);
            return 2;
        }
    }
    for (const std::string& solver : solvers) {
        for (std::uint64_t k = 0; k < problems; ++k) {
            const std::string failure = labeling_test::fuzz_failure(solver, seed + k, size);
            if (failure.empty()) continue;
            std::printf("%s\n", failure.c_str());
            return 1;
        }
        std::printf("%s: %llu problems\n", solver.c_str(),
                    static_cast<unsigned long long>(problems));
    }
    return 0;
}
