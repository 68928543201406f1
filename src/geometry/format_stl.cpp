// STL, text and binary. Facets do not share corners, so equal positions are always welded; normals
// are ignored (the corner order says the same). Several solids in one text file are labels.

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "geometry/errors.h"
#include "geometry/mesh_formats.h"
#include "geometry/text_cursor.h"
#include "geometry/text_writer.h"

namespace fcn {

namespace {

constexpr std::size_t kHeaderSize = 80;
constexpr std::size_t kFacetSize = 50;

std::uint32_t little_endian_32(const char* bytes) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

bool is_word(std::string_view token, std::string_view word) {
    return token.size() == word.size() &&
           std::equal(token.begin(), token.end(), word.begin(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) == b;
           });
}

void expect_word(TextCursor& in, std::string_view word) {
    const std::string_view found = in.token();
    if (is_word(found, word)) return;
    in.fail("expected " + shown(word) + ", found " +
            (found.empty() ? std::string("the end of the file") : shown(found)));
}

void read_facet(TextCursor& in, PolygonSoup& soup) {
    expect_word(in, "normal");
    // Writers put nan here for degenerate facets: not our business.
    for (int i = 0; i < 3; ++i) in.token();
    expect_word(in, "outer");
    expect_word(in, "loop");
    for (int i = 0; i < 3; ++i) {
        expect_word(in, "vertex");
        soup.corners.push_back(static_cast<int>(soup.points.size()));
        soup.points.push_back(in.point("a vertex coordinate"));
    }
    expect_word(in, "endloop");
    expect_word(in, "endfacet");
    soup.close_polygon();
}

}  // namespace

PolygonSoup read_stl_text(std::string_view content, const std::string& source) {
    TextCursor in(content, source);
    PolygonSoup soup;
    soup.is_unconnected = true;
    int solid_count = 0;
    for (std::string_view word = in.token(); !word.empty(); word = in.token()) {
        if (!is_word(word, "solid")) in.fail("expected 'solid', found " + shown(word));
        soup.label_names.emplace_back(in.rest_of_line());
        for (;;) {
            const std::string_view next = in.token();
            if (is_word(next, "endsolid")) break;
            if (next.empty()) in.fail("the file is truncated: no 'endsolid'");
            if (!is_word(next, "facet")) in.fail("expected 'facet', found " + shown(next));
            read_facet(in, soup);
            soup.labels.push_back(solid_count);
        }
        in.skip_line();
        ++solid_count;
    }
    if (solid_count < 2) {
        soup.labels.clear();
        soup.label_names.clear();
    }
    return soup;
}

PolygonSoup read_stl_binary(std::string_view content, const std::string& source) {
    if (content.size() < kHeaderSize + 4) {
        throw InputError(source + ": a binary STL has at least 84 bytes, this file has " +
                         std::to_string(content.size()));
    }
    const std::size_t count = little_endian_32(content.data() + kHeaderSize);
    if (content.size() < kHeaderSize + 4 + count * kFacetSize) {
        throw InputError(source + ": binary STL with " + std::to_string(count) + " facets needs " +
                         std::to_string(kHeaderSize + 4 + count * kFacetSize) +
                         " bytes, the file has " + std::to_string(content.size()) +
                         ": truncated or damaged");
    }
    PolygonSoup soup;
    soup.is_unconnected = true;
    soup.precision = 0x1p-24;
    soup.points.reserve(3 * count);
    soup.corners.reserve(3 * count);
    soup.corner_begin.reserve(count + 1);
    for (std::size_t facet = 0; facet < count; ++facet) {
        const char* bytes = content.data() + kHeaderSize + 4 + facet * kFacetSize + 12;
        for (int corner = 0; corner < 3; ++corner) {
            Vec3 point;
            for (int axis = 0; axis < 3; ++axis, bytes += 4) {
                const auto value = std::bit_cast<float>(little_endian_32(bytes));
                if (!std::isfinite(value)) {
                    throw InputError(source + ": facet " + std::to_string(facet) +
                                     ": a coordinate is not finite");
                }
                point[axis] = value;
            }
            soup.corners.push_back(static_cast<int>(soup.points.size()));
            soup.points.push_back(point);
        }
        soup.close_polygon();
    }
    return soup;
}

std::string write_stl(const LoadedMesh& loaded) {
    // Text, since binary STL has single precision and no place for labels.
    const Mesh& mesh = loaded.mesh;
    TextWriter out;
    std::string name = loaded.name.empty() ? "mesh" : loaded.name;
    int current = 0;
    bool is_open = false;
    const auto close = [&] {
        if (is_open) out << "endsolid " << name << '\n';
    };
    for (int index : faces_by_label(loaded)) {
        const FaceHandle face(index);
        const int label = label_of(loaded, index);
        if (!is_open || label != current) {
            close();
            if (!loaded.face_labels.empty()) name = label_name(loaded, label);
            out << "solid " << name << '\n';
            current = label;
            is_open = true;
        }
        out << "facet normal " << face_normal(mesh, face) << "\nouter loop\n";
        for (VertexHandle vertex : face_vertices(mesh, face)) {
            out << "vertex " << mesh.point(vertex) << '\n';
        }
        out << "endloop\nendfacet\n";
    }
    close();
    return out.take();
}

}  // namespace fcn
