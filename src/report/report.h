#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adaptation/adaptation.h"
#include "adaptation/conformity.h"
#include "meshing/comparison.h"
#include "meshing/quad_quality.h"
#include "meshing/remesh.h"
#include "meshing/remesh_quads.h"

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
    std::string name;   ///< what was done: "on the initial network"
    ComparisonRow row;  ///< the mesh and its measures, or why there is none
};

/// Quads of one scale and their measures.
struct QuadRecord {
    QuadResult result;
    QuadQuality quality;
    MeshDistance distance;    ///< against the input
    QuadAlignment alignment;  ///< with the adapted network
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
    ComparisonRow remesh_row;            ///< measures of the remesh; its mesh is above
    std::vector<ComparedMesh> compared;  ///< the remesh on the initial network, and baselines
    std::optional<QuadRecord> quads;     ///< where quads are the target
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

/// The report while its meshes come in: a mesh is drawn when it is added and can go then.
class Report {
public:
    struct State;

    /// Pictures and 3D views of `mesh_count` meshes share the space of one file.
    Report(ReportOptions options, std::size_t mesh_count);
    ~Report();
    Report(Report&&) noexcept;

    void add(const MeshRecord& record);
    /// One self-contained HTML file of what was added so far: pictures and the viewer's data are in
    /// it. Readable offline. Throws InputError when the script cannot stand in a page.
    std::string html() const;

private:
    std::unique_ptr<State> state_;
};

/// All of it at once, written atomically.
void write_report(const std::filesystem::path& path, const std::vector<MeshRecord>& meshes,
                  const ReportOptions& options = {});

}  // namespace fcn
