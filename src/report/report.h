#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adaptation/adaptation.h"
#include "adaptation/conformity.h"
#include "meshing/measure.h"
#include "meshing/remesh.h"

namespace fcn {

/// One solver on one problem, side by side with the others.
struct SolverComparison {
    std::string problem;  ///< e.g. "iteration 1"
    std::string solver;
    std::string status;  ///< optimal, feasible, ...
    double value = 0;    ///< real units
    double bound = 0;    ///< NaN when none
    double gap = 0;      ///< relative; NaN when none
    double seconds = 0;
};

/// Another mesh made for the same edge length, to set beside the remesh.
struct ComparedMesh {
    std::string name;  ///< what was done: "on the initial network"
    Mesh mesh;
    TriangleQuality quality;
};

/// Everything that was done for one mesh at one scale.
struct ScaleRecord {
    std::string label;  ///< as typed: "2%"
    double rmin = 0;
    AdaptationResult adaptation;
    ConformityReport conformity;
    std::vector<SolverComparison> solvers;
    LoadedMesh remesh;  ///< on the adapted network
    TriangleQuality remesh_quality;
    TriangleQuality initial_quality;  ///< remeshed with the initial network protected
    bool has_remesh = false, has_initial_remesh = false;
    std::vector<ComparedMesh> compared;  ///< for the 3D view alone
};

struct MeshRecord {
    LoadedMesh mesh;
    FeatureCurveNetwork initial;
    std::string method;
    std::vector<ScaleRecord> scales;
    std::vector<std::string> messages;  ///< repairs, warnings
};

struct ReportOptions {
    std::string title = "scalefcn report";
    std::string command;  ///< the command line that made it
    bool has_timings = true;
    std::string viewer_script;  ///< the 3D viewer's JavaScript; empty: pictures only
};

/// One self-contained HTML file (pictures and the viewer's data embedded), written atomically.
/// Readable offline. Throws InputError when the script cannot stand in a page.
void write_report(const std::filesystem::path& path, const std::vector<MeshRecord>& meshes,
                  const ReportOptions& options = {});

}  // namespace fcn
