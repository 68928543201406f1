#pragma once

#include <optional>
#include <string>
#include <vector>

#include "features/crest.h"
#include "features/features.h"

namespace CLI {
class App;
}

namespace fcn::app {

/// Options of `--method crest`.
struct CrestArguments {
    std::string kind = "both";
    std::string scale = "auto";  ///< edges around a vertex, or a share of the diagonal
    CrestOptions options;        ///< the thresholds that files do not hold, and the gap
    std::optional<double> ridgeness, sphericalness, cyclideness;
    std::string min_length;  ///< empty = any
    bool is_alone = false;   ///< without sharp edges
    std::vector<std::string> import_paths;
};

void add_crest_arguments(CLI::App& parser, CrestArguments& arguments);

/// Detects crest lines behind the sharp edges that `sharp` describes, or reads them from files.
FeatureCurveNetwork detect_crests(const LoadedMesh& mesh, const CrestArguments& arguments,
                                  const SharpOptions& sharp, double diagonal, int threads);

}  // namespace fcn::app
