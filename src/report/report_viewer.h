#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/html.h"
#include "report/report.h"

namespace fcn {

/// The data of a mesh's 3D view: blocks by name, of meshes with at most `face_limit` faces.
struct ViewerBlocks {
    std::vector<std::pair<std::string, std::string>> blocks;
};
ViewerBlocks make_viewer_blocks(const MeshRecord& record, std::size_t face_limit);

/// The place of a mesh's 3D view and its data; the view itself is drawn by the script. `id` is the
/// element's id.
void write_viewer(HtmlWriter& html, const MeshRecord& record, const std::string& id,
                  const ViewerBlocks& blocks);

/// The script that fills all places. Throws InputError when it cannot stand in a page.
void write_viewer_script(HtmlWriter& html, const std::string& script);

/// What the 3D view shows of a mesh: the number of faces of each of its meshes.
std::vector<std::size_t> viewer_face_counts(const MeshRecord& record);

}  // namespace fcn
