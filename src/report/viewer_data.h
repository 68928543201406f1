#pragma once

#include <string>

#include "geometry/surface_queries.h"
#include "report/report.h"
#include "report/viewer_block.h"

namespace fcn {

/// What the 3D view shows of one mesh, in compressed blocks: one for the model and its initial
/// network, one for each scale. Every named mesh of a scale goes in: the remesh and all that is
/// compared with it. docs/formats.md describes the headers.
class ViewerData {
public:
    /// Meshes with more than `face_limit` faces are decimated.
    ViewerData(const MeshRecord& record, std::size_t face_limit);

    std::string model() const;
    std::string level(const ScaleRecord& scale) const;

private:
    nlohmann::json adapted_lines(BlockWriter& block, const FeatureCurveNetwork& network) const;
    nlohmann::json dropped_lines(BlockWriter& block, const FeatureCurveNetwork& network) const;
    void add_quad_layers(BlockWriter& block, const QuadRecord& quads, nlohmann::json& header) const;

    const MeshRecord& record_;
    std::size_t face_limit_ = 0;
    PointGrid grid_;
    SurfaceQueries surface_;
    double tolerance_ = 0;           ///< of polylines, mesh units
    std::vector<int> curve_of_arc_;  ///< of the initial network
    std::vector<double> curve_length_;
};

/// The largest number of faces per mesh with which all meshes together have at most `budget`;
/// meshes below it stay whole.
std::size_t fair_face_limit(std::vector<std::size_t> face_counts, std::size_t budget);

}  // namespace fcn
