// Which format: a signature in the content decides, else the name. Reading ends with validate(), so
// whatever a file says, what comes out is a network or an InputError.

#include "network/network_io.h"

#include <algorithm>
#include <cctype>

#include "geometry/errors.h"
#include "network/crest_file.h"
#include "network/network_formats.h"
#include "network/place_on_surface.h"

namespace fcn {
namespace {

enum class Format { Json, Obj, Ply, Vtp, Medit, Gmsh, Sharp, Fl, Polylines, Crest, Unknown };

constexpr const char* kKnownNames =
    ".fcn.json, .obj, .ply, .vtp, .mesh, .msh, .sharp, .fl or .polylines.txt (or one of them .gz)";
constexpr const char* kReadOnlyNames = "; read alone are ridges.txt and ravines.txt";

Format format_of_name(const std::filesystem::path& path) {
    if (is_crest_file_name(path)) return Format::Crest;
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    constexpr std::pair<const char*, Format> kEndings[] = {
        {".json", Format::Json},     {".obj", Format::Obj},
        {".ply", Format::Ply},       {".vtp", Format::Vtp},
        {".mesh", Format::Medit},    {".msh", Format::Gmsh},
        {".sharp", Format::Sharp},   {".fl", Format::Fl},
        {".txt", Format::Polylines}, {".polylines", Format::Polylines},
    };
    for (const auto& [ending, format] : kEndings)
        if (name.ends_with(ending)) return format;
    return Format::Unknown;
}

Format format_of_content(std::string_view content) {
    const std::size_t begin = content.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return Format::Unknown;
    const std::string_view start = content.substr(begin);
    if (start.front() == '{') return Format::Json;
    if (start.front() == '<') return Format::Vtp;
    if (start.starts_with("$MeshFormat")) return Format::Gmsh;
    if (start.starts_with("MeshVersionFormatted")) return Format::Medit;
    if (start.starts_with("ply\n") || start.starts_with("ply\r")) return Format::Ply;
    return Format::Unknown;
}

const Mesh& needed(const Mesh* mesh, const std::string& source) {
    if (!mesh)
        throw InputError(source +
                         ": this format numbers the elements of a mesh; "
                         "give the mesh as well");
    return *mesh;
}

EdgeSoup read_edges(Format format, const std::string& content, const std::string& source,
                    const Mesh* mesh) {
    switch (format) {
        case Format::Obj:
            return read_obj_lines(content, source);
        case Format::Ply:
            return read_ply_edges(content, source);
        case Format::Vtp:
            return read_vtp_lines(content, source);
        case Format::Medit:
            return read_medit_edges(content, source);
        case Format::Gmsh:
            return read_gmsh_lines(content, source);
        case Format::Sharp:
            return read_sharp(content, source, needed(mesh, source));
        case Format::Fl:
            return read_fl(content, source, needed(mesh, source));
        case Format::Crest:
            return crest_edges(read_crest_file(content, source));
        default:
            return read_polylines(content, source);
    }
}

void expect_valid(const std::vector<std::string>& problems, const std::string& source) {
    if (problems.empty()) return;
    throw InputError(source + ": " + problems.front() +
                     (problems.size() == 1
                          ? std::string()
                          : " (and " + std::to_string(problems.size() - 1) + " more)"));
}

std::string encode(Format format, const std::string& target, const FeatureCurveNetwork& network,
                   NetworkDetail detail, const LoadedMesh* mesh) {
    if (format == Format::Json) return network_to_json(network);
    const WrittenNetwork written = polylines_to_write(network, detail);
    const Mesh* const surface = mesh ? &mesh->mesh : nullptr;
    switch (format) {
        case Format::Obj:
            return write_obj_lines(written);
        case Format::Ply:
            return write_ply_edges(written);
        case Format::Vtp:
            return write_vtp_lines(written);
        case Format::Medit:
            return write_medit_edges(written);
        case Format::Gmsh:
            return write_gmsh_lines(written);
        case Format::Sharp:
            return write_sharp(written, needed(surface, target), target);
        case Format::Fl:
            return write_fl(written, needed(surface, target), target);
        default:
            return write_polylines(written);
    }
}

}  // namespace

FeatureCurveNetwork read_network(const std::filesystem::path& path, const Mesh* mesh) {
    return network_from_content(read_file(path), path, mesh);
}

FeatureCurveNetwork network_from_content(const std::string& content,
                                         const std::filesystem::path& name, const Mesh* mesh) {
    const std::string source = name == "-" ? "standard input" : name.string();
    if (content.empty()) throw InputError(source + ": the file is empty");
    Format format = format_of_content(content);
    if (format == Format::Unknown) format = format_of_name(name);
    if (format == Format::Unknown)
        throw InputError(source + ": not a network format by content or name; expected " +
                         kKnownNames + kReadOnlyNames);
    FeatureCurveNetwork network = format == Format::Json
                                      ? network_from_json(content, source)
                                      : chain_edges(read_edges(format, content, source, mesh));
    if (mesh) place_on_surface(network, *mesh, source);
    expect_valid(mesh ? validate(network, *mesh) : validate(network), source);
    return network;
}

void write_network(const std::filesystem::path& path, const FeatureCurveNetwork& network,
                   NetworkDetail detail, const LoadedMesh* mesh) {
    const Format format = path == "-" ? Format::Json : format_of_name(path);
    const std::string target = path.string();
    if (format == Format::Crest)
        throw InputError(target + ": this format is read alone; write " + kKnownNames);
    if (format == Format::Unknown)
        throw InputError(target + ": unknown network format; expected " + kKnownNames);
    write_file_atomically(path, encode(format, target, network, detail, mesh));
}

}  // namespace fcn
