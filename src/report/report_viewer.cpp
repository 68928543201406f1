#include "report/report_viewer.h"

#include "geometry/errors.h"
#include "report/viewer_data.h"

namespace fcn {
namespace {

/// About 6 bytes of page each, so that 15 MB of meshes are never exceeded by much.
constexpr std::size_t kFaceBudget = 2'500'000;
/// More than a screen has pixels for.
constexpr std::size_t kMostFaces = 400'000;

void write_block(HtmlWriter& html, const std::string& id, const std::string& name,
                 const std::string& bytes) {
    html.open("script", {{"type", "text/plain"}, {"data-viewer", id}, {"data-block", name}});
    html.raw(encode_base64(bytes));
    html.close();
}

}  // namespace

void write_viewer(HtmlWriter& html, const MeshRecord& record, const std::string& id,
                  std::size_t face_limit) {
    html.open("div", {{"class", "viewer"}, {"id", id}, {"data-name", record.mesh.name}});
    html.element("p", "The 3D view needs scripts and WebGL 2; the pictures below show the same.",
                 {{"class", "facts"}});
    html.close();
    const ViewerData data(record, face_limit);
    write_block(html, id, "model", data.model());
    for (const ScaleRecord& scale : record.scales)
        write_block(html, id, scale.label, data.level(scale));
}

void write_viewer_script(HtmlWriter& html, const std::string& script) {
    if (script.find("</script") != std::string::npos)
        throw InputError("the viewer's script contains </script and cannot stand in a page");
    html.open("script");
    html.raw(script);
    html.close();
}

std::size_t viewer_face_limit(const std::vector<MeshRecord>& meshes) {
    std::vector<std::size_t> counts;
    for (const MeshRecord& record : meshes) {
        counts.push_back(record.mesh.mesh.n_faces());
        for (const ScaleRecord& scale : record.scales) {
            if (scale.has_remesh) counts.push_back(scale.remesh.mesh.n_faces());
            for (const ComparedMesh& compared : scale.compared)
                counts.push_back(compared.mesh.n_faces());
        }
    }
    return std::min(kMostFaces, fair_face_limit(std::move(counts), kFaceBudget));
}

}  // namespace fcn
