#include "app/field_outputs.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/command.h"
#include "app/outputs.h"
#include "geometry/errors.h"
#include "meshing/field_file.h"
#include "meshing/quad_field.h"

namespace fcn::app {
namespace {

bool is_rosy(const std::string& path) {
    return path.ends_with(".rosy") || path.ends_with(".rosy.gz");
}

}  // namespace

FieldOutputs prepare_field_outputs(const std::vector<std::string>& files,
                                   const std::vector<std::string>& others,
                                   const CommonArguments& common) {
    FieldOutputs outputs;
    for (const std::string& file : files) {
        if (file == "-") throw UsageError("--field names files, not standard output");
        if (std::ranges::find(others, file) != others.end())
            throw UsageError(fmt::format("{} is named after -o and after --field", file));
        std::string& place = is_rosy(file) ? outputs.rosy : outputs.mesh;
        if (!place.empty())
            throw UsageError(fmt::format("--field: one {}, not {} and {}",
                                         is_rosy(file) ? ".rosy file" : "mesh file", place, file));
        place = file;
        prepare_output(file, is_rosy(file) ? OutputKind::Other : OutputKind::Mesh, common);
    }
    if (!files.empty() && outputs.rosy.empty())
        throw UsageError(fmt::format("--field: {} is no .rosy file", outputs.mesh));
    return outputs;
}

void require_field(const FieldOutputs& outputs, const QuadResult& quads) {
    if (outputs.rosy.empty() || quads.field) return;
    throw InputError(
        fmt::format("{}: nothing to write, the quads were made by pairing, which has no field ({})",
                    outputs.rosy, quads.reason.empty() ? "as asked for" : quads.reason));
}

std::vector<std::string> save_field(const FieldOutputs& outputs, const QuadField& field,
                                    const Mesh& input) {
    std::vector<std::string> files;
    if (outputs.rosy.empty()) return files;
    files.push_back(outputs.rosy);
    save_text(outputs.rosy,
              rosy_text(outputs.mesh.empty() ? arms_on_faces(field, input) : field.arms));
    if (!outputs.mesh.empty()) {
        save_mesh(outputs.mesh, field.mesh);
        files.push_back(outputs.mesh);
    }
    return files;
}

}  // namespace fcn::app
