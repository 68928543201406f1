#pragma once

#include <string>
#include <vector>

#include "report/report.h"
#include "report/report_pictures.h"
#include "report/report_viewer.h"

namespace fcn {

/// Pictures of one scale, as PNG; empty where there is none.
struct DrawnScale {
    std::string fate, adapted, remesh, quads;
};

/// What of a mesh has been drawn for its section of the report.
struct DrawnMesh {
    int width = 0, height = 0;  ///< pixels
    std::string initial, orbits;
    std::vector<DrawnScale> scales;
    bool has_viewer = false;
    ViewerBlocks viewer;

    std::size_t picture_bytes() const;
};

/// Names of places in the page, for links.
std::string mesh_id(std::size_t mesh);
std::string scale_id(std::size_t mesh, std::size_t scale);

/// The section of the mesh that is the `number`-th in the report, from 0, as HTML.
std::string write_section(const MeshRecord& record, std::size_t number, const DrawnMesh& drawn,
                          bool has_timings);

/// Draws all pictures of a mesh at this size, several at a time.
DrawnMesh draw_pictures(const MeshRecord& record, int width, int height);

}  // namespace fcn
