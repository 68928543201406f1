#pragma once

#include <vector>

#include "report/html.h"
#include "report/report.h"

namespace fcn {

/// The place of a mesh's 3D view and its data; the view itself is drawn by the script. `id` is the
/// element's id.
void write_viewer(HtmlWriter& html, const MeshRecord& record, const std::string& id,
                  std::size_t face_limit);

/// The script that fills all places. Throws InputError when it cannot stand in a page.
void write_viewer_script(HtmlWriter& html, const std::string& script);

/// Faces that one mesh may have in the 3D view so that the report stays small enough to pass on.
std::size_t viewer_face_limit(const std::vector<MeshRecord>& meshes);

}  // namespace fcn
