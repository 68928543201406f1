#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiment/campaign_runs.h"

namespace experiment {

/// A campaign that goes into a library, and where its files lie.
struct LibrarySource {
    CampaignRuns campaign;
    std::filesystem::path folder;
};

struct LibraryOptions {
    std::int64_t proof_nodes = 0;  ///< for the proof of each problem that is solved; 0: no proofs
    std::function<void(const std::string&)> tell;
};

struct LibraryResult {
    std::size_t problems = 0, proven = 0, certificates = 0;
};

/// Writes the conflict-graph library: per problem NAME.lab.gz, NAME.mps.gz (strengthened rows),
/// NAME.json (sizes, hash, origin, best value and bound and who found them), NAME.sol.gz (best
/// labels), NAME.pbp.gz (a proof that VeriPB accepts, against `convert NAME.lab.gz NAME.opb`), and
/// over all manifest.json and scoreboard.md. Problems of equal content appear once. Throws
/// InputError when nothing can be written or two campaigns contradict each other.
LibraryResult export_library(const std::vector<LibrarySource>& sources,
                             const std::filesystem::path& folder,
                             const LibraryOptions& options = {});

}  // namespace experiment
