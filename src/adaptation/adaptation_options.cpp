#include "adaptation/adaptation_options.h"

#include <cmath>

#include "adaptation/working_network.h"
#include "geometry/errors.h"

namespace fcn {
namespace {

constexpr double kBestLoopFactor = 4;
constexpr double kPaperLoopFactor = 100;
constexpr double kQuadOrthogonality = 10;
/// More samples than this do not fit into memory.
constexpr double kMostSamples = 5e7;

void require(bool condition, const std::string& message) {
    if (!condition) throw InputError(message);
}

void check_options(const AdaptationOptions& options) {
    require(options.solver != nullptr, "adaptation needs a solver");
    require(options.lambda0 >= 0 && std::isfinite(options.lambda0), "lambda0 must be >= 0");
    require(std::isfinite(options.lambda1), "lambda1 must be finite");
    require(options.alpha_sym > 0 && std::isfinite(options.alpha_sym), "alpha-sym must be > 0");
    require(options.alpha_loop != 0 && std::isfinite(options.alpha_loop), "alpha-loop must be > 0");
    require(options.smooth_power > 0 && std::isfinite(options.smooth_power),
            "smooth-power must be > 0");
    require(options.ortho_radius > 0 && std::isfinite(options.ortho_radius),
            "ortho-radius must be > 0");
    require(options.max_iterations >= 1, "at least one iteration is needed");
}

void check_size(const FeatureCurveNetwork& initial, const AdaptationOptions& options) {
    const double spacing = sample_spacing(make_scale(options.rmin, options.ratio, options.target));
    const double length = initial.total_length();
    require(length / spacing <= kMostSamples,
            "scale " + std::to_string(options.rmin) + " is too small for curves of length " +
                std::to_string(length) + ": they would need more than " +
                std::to_string(static_cast<long>(kMostSamples)) + " samples");
}

}  // namespace

AdaptationOptions with_defaults(AdaptationOptions options) {
    if (options.lambda1 < 0) {
        options.lambda1 = options.target == ElementType::Quad ? kQuadOrthogonality : 0;
    }
    if (options.alpha_loop < 0) {
        options.alpha_loop =
            options.mode == AdaptationMode::Paper ? kPaperLoopFactor : kBestLoopFactor;
    }
    return options;
}

void require_valid(const AdaptationOptions& options, const FeatureCurveNetwork& initial) {
    check_options(options);
    check_size(initial, options);
}

}  // namespace fcn
