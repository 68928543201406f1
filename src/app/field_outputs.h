#pragma once

#include <string>
#include <vector>

#include "app/common_arguments.h"
#include "meshing/remesh_quads.h"

namespace fcn::app {

/// What --field names.
struct FieldOutputs {
    std::string rosy;  ///< empty: nothing was asked for
    std::string mesh;  ///< for the triangles that carried the field; empty: MESH's faces have it
};

/// Throws UsageError unless `files` is empty, or one .rosy file and at most one mesh file besides,
/// none of them among `others`. Makes their folders.
FieldOutputs prepare_field_outputs(const std::vector<std::string>& files,
                                   const std::vector<std::string>& others,
                                   const CommonArguments& common);

/// InputError when the field was asked for and the quads follow none.
void require_field(const FieldOutputs& outputs, const QuadResult& quads);

/// Writes what was asked for, each file atomically; returns the files.
std::vector<std::string> save_field(const FieldOutputs& outputs, const QuadField& field,
                                    const Mesh& input);

}  // namespace fcn::app
