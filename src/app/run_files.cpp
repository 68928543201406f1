#include "app/run_files.h"

#include <fmt/core.h>

#include "app/field_outputs.h"
#include "labeling/formats.h"
#include "meshing/quad_files.h"
#include "network/network_io.h"

namespace fcn::app {

std::vector<std::string> write_problems(const AdaptationReport& report,
                                        const std::filesystem::path& folder) {
    std::vector<std::string> files;
    if (report.problems.empty()) return files;
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < report.problems.size(); ++i) {
        const auto problem_path = folder / fmt::format("problem_{}.lab.gz", i + 1);
        labeling::write_problem(report.problems[i], problem_path);
        files.push_back(problem_path.string());
        if (i >= report.solutions.size() || report.solutions[i].labels.empty()) continue;
        const auto solution_path = folder / fmt::format("problem_{}.sol", i + 1);
        labeling::write_solution(report.solutions[i], solution_path);
        files.push_back(solution_path.string());
    }
    return files;
}

std::vector<std::string> write_steps(const AdaptationReport& report,
                                     const std::filesystem::path& folder) {
    std::vector<std::string> files;
    std::filesystem::create_directories(folder);
    const auto write = [&](std::size_t step, const char* kind,
                           const AdaptationStep::Chords& chords) {
        if (chords.empty()) return;
        std::string text;
        for (const auto& [from, to] : chords)
            for (const Vec3& p : {from, to})
                text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
        for (std::size_t i = 0; i < chords.size(); ++i)
            text += fmt::format("l {} {}\n", 2 * i + 1, 2 * i + 2);
        files.push_back((folder / fmt::format("step_{}_{}.obj", step + 1, kind)).string());
        write_file_atomically(files.back(), text);
    };
    for (std::size_t i = 0; i < report.steps.size(); ++i) {
        const AdaptationStep& step = report.steps[i];
        write(i, "resampled", step.resampled);
        write(i, "short", step.brief);
        write(i, "kept", step.kept);
        write(i, "dropped", step.dropped);
    }
    return files;
}

std::vector<std::string> write_scale_files(const MeshRecord& record, const ScaleRecord& scale,
                                           const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::vector<std::string> files;
    const auto write = [&](const char* name, const FeatureCurveNetwork& network,
                           NetworkDetail detail) {
        const auto path = folder / name;
        write_network(path, network, detail, &record.mesh);
        files.push_back(path.string());
    };
    write("initial.fcn.json", record.initial, NetworkDetail::DenseArcs);
    write("adapted.fcn.json", scale.adaptation.network, NetworkDetail::Segments);
    write("initial.obj", record.initial, NetworkDetail::DenseArcs);
    write("network.obj", scale.adaptation.network, NetworkDetail::Segments);
    if (scale.has_remesh) {
        write_mesh(folder / "remesh.obj", scale.remesh);
        files.push_back((folder / "remesh.obj").string());
    }
    if (scale.quads) {
        write_quads(folder / "quads.obj", scale.quads->result.mesh);
        files.push_back((folder / "quads.obj").string());
        if (scale.quads->result.field)
            for (std::string& file :
                 save_field({(folder / "field.rosy").string(), (folder / "field.obj").string()},
                            *scale.quads->result.field, record.mesh.mesh))
                files.push_back(std::move(file));
    }
    for (std::string& file : write_problems(scale.adaptation.report, folder))
        files.push_back(std::move(file));
    return files;
}

}  // namespace fcn::app
