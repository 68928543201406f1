#include "report/report_viewer.h"

#include <oneapi/tbb/parallel_for.h>

#include "geometry/errors.h"
#include "report/viewer_data.h"

namespace fcn {
namespace {

void write_block(HtmlWriter& html, const std::string& id, const std::string& name,
                 const std::string& bytes) {
    html.open("script", {{"type", "text/plain"}, {"data-viewer", id}, {"data-block", name}});
    html.raw(encode_base64(bytes));
    html.close();
}

}  // namespace

ViewerBlocks make_viewer_blocks(const MeshRecord& record, std::size_t face_limit) {
    const ViewerData data(record, face_limit);
    ViewerBlocks result;
    result.blocks.resize(1 + record.scales.size());
    tbb::parallel_for(std::size_t{0}, result.blocks.size(), [&](std::size_t i) {
        result.blocks[i] =
            i == 0 ? std::pair{std::string("model"), data.model()}
                   : std::pair{record.scales[i - 1].label, data.level(record.scales[i - 1])};
    });
    return result;
}

void write_viewer(HtmlWriter& html, const MeshRecord& record, const std::string& id,
                  const ViewerBlocks& blocks) {
    html.open("div", {{"class", "viewer"}, {"id", id}, {"data-name", record.mesh.name}});
    html.element("p", "The 3D view needs scripts and WebGL 2; the pictures below show the same.",
                 {{"class", "facts"}});
    html.close();
    for (const auto& [name, bytes] : blocks.blocks) write_block(html, id, name, bytes);
}

void write_viewer_script(HtmlWriter& html, const std::string& script) {
    if (script.find("</script") != std::string::npos)
        throw InputError("the viewer's script contains </script and cannot stand in a page");
    html.open("script");
    html.raw(script);
    html.close();
}

std::vector<std::size_t> viewer_face_counts(const MeshRecord& record) {
    std::vector<std::size_t> counts{record.mesh.mesh.n_faces()};
    for (const ScaleRecord& scale : record.scales) {
        if (scale.has_remesh) counts.push_back(scale.remesh.mesh.n_faces());
        if (scale.quads) counts.push_back(2 * scale.quads->result.mesh.faces.size());
        for (const ComparedMesh& compared : scale.compared)
            counts.push_back(compared.row.mesh.mesh.n_faces());
    }
    return counts;
}

}  // namespace fcn
