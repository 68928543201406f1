// VTK .vtp (XML PolyData, text): one polyline cell per segment, or per arc of a network without
// segments, and one per dropped piece. Cell data: arc (from 0; of a dropped piece its arc in the
// initial network), weight, state (1 kept, 0 dropped), reason (a string; in VTK's text form a
// list of character codes, each string ended by 0), margin (of a dropped piece, -1 without one),
// and of the heaviest of its blockers blocker_arc, blocker_weight and blocker_conflict. Read: the
// first four as far as they are there; a file without "arc" has its edges chained.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "geometry/text_writer.h"
#include "network/network_formats.h"
#include "network/xml_scanner.h"

namespace fcn {
namespace {

std::string shortest(double value) {
    TextWriter out;
    out << value;
    return out.take();
}

/// The numbers of one DataArray.
struct Column {
    std::vector<double> values;
    std::size_t offset = 0;  ///< in the file, for messages
    bool is_there = false;
};

/// One <Piece> of a PolyData file.
struct Piece {
    std::size_t vertex_cells = 0;  ///< cells before the lines in the cell data
    std::size_t offset = 0;
    Column points, connectivity, offsets, arc, weight, state, reason;
};

class VtpLines {
public:
    VtpLines(std::string_view content, const std::string& source) : xml_(content, source) {}

    EdgeSoup run() {
        std::optional<Piece> piece;
        std::string_view group;  // Points, Lines, CellData, ...
        bool has_root = false;
        for (XmlEvent event = xml_.next(); event.kind != XmlEvent::Kind::EndOfFile;
             event = xml_.next()) {
            if (event.kind == XmlEvent::Kind::Text) continue;
            if (event.kind == XmlEvent::Kind::End) {
                if (event.name == "Piece" && piece) {
                    add(*piece);
                    piece.reset();
                }
                continue;
            }
            if (event.name == "VTKFile") {
                if (event.attribute("type") != "PolyData")
                    xml_.fail(event.offset, "the file's type is not PolyData");
                has_root = true;
            } else if (event.name == "AppendedData") {
                xml_.fail(event.offset, "appended data is not supported, save as text");
            } else if (event.name == "Piece") {
                piece.emplace();
                piece->offset = event.offset;
                piece->vertex_cells = count_of(event, "NumberOfVerts");
            } else if (event.name == "DataArray" || event.name == "Array") {
                if (piece) read_array(event, group, *piece);
            } else {
                group = event.name;
            }
        }
        if (!has_root) xml_.fail(0, "no <VTKFile>: this is no VTK XML file");
        if (piece) xml_.fail(piece->offset, "a <Piece> does not end");
        if (soup_.edges.empty() && soup_.dropped.empty() && !soup_.points.empty())
            xml_.fail(0, "no lines among " + std::to_string(soup_.points.size()) +
                             " points: no curves in it");
        return std::move(soup_);
    }

private:
    std::size_t count_of(const XmlEvent& event, std::string_view name) const {
        const std::string_view text = event.attribute(name);
        if (text.empty()) return 0;
        std::size_t count = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
        if (error != std::errc() || end != text.data() + text.size())
            xml_.fail(event.offset, std::string(name) + " is no count");
        return count;
    }

    static Column* wanted(std::string_view group, std::string_view name, Piece& piece) {
        if (group == "Points") return &piece.points;
        if (group == "Lines" && name == "connectivity") return &piece.connectivity;
        if (group == "Lines" && name == "offsets") return &piece.offsets;
        if (group != "CellData") return nullptr;
        if (name == "arc") return &piece.arc;
        if (name == "weight") return &piece.weight;
        if (name == "state") return &piece.state;
        return name == "reason" ? &piece.reason : nullptr;
    }

    void read_array(const XmlEvent& event, std::string_view group, Piece& piece) {
        Column* column = wanted(group, event.attribute("Name"), piece);
        if (!column) return;
        if (event.attribute("format") != "ascii" && !event.attribute("format").empty())
            xml_.fail(event.offset, "only format=\"ascii\" is supported, save as text");
        column->is_there = true;
        column->offset = event.offset;
        if (event.is_empty) return;
        // The text may come in parts, around comments.
        for (XmlEvent part = xml_.next(); part.kind != XmlEvent::Kind::End; part = xml_.next()) {
            if (part.kind == XmlEvent::Kind::EndOfFile)
                xml_.fail(event.offset, "a DataArray does not end");
            if (part.kind == XmlEvent::Kind::Text)
                read_numbers(part, *column);
            else
                skip_element(part);
        }
    }

    /// Elements inside an array (<InformationKey>) are of no interest.
    void skip_element(const XmlEvent& start) {
        int depth = start.is_empty ? 0 : 1;
        while (depth > 0) {
            const XmlEvent event = xml_.next();
            if (event.kind == XmlEvent::Kind::EndOfFile)
                xml_.fail(start.offset, "an element does not end");
            if (event.kind == XmlEvent::Kind::Start && !event.is_empty) ++depth;
            if (event.kind == XmlEvent::Kind::End) --depth;
        }
    }

    void read_numbers(const XmlEvent& part, Column& column) {
        const char* at = part.text.data();
        const char* const end = at + part.text.size();
        const auto is_space = [](char c) {
            return c == ' ' || c == '\n' || c == '\t' || c == '\r';
        };
        while (true) {
            at = std::find_if_not(at, end, is_space);
            if (at == end) return;
            const char* const word_end = std::find_if(at, end, is_space);
            double value = 0;
            const auto [stop, error] = std::from_chars(at, word_end, value);
            // from_chars does not tell overflow from underflow; strtod does.
            if (error == std::errc::result_out_of_range)
                value = std::strtod(std::string(at, word_end).c_str(), nullptr);
            const bool is_number = error == std::errc() || error == std::errc::result_out_of_range;
            if (!is_number || stop != word_end || !std::isfinite(value)) {
                const std::size_t offset =
                    part.offset + static_cast<std::size_t>(at - part.text.data());
                const std::size_t shown = std::min<std::size_t>(word_end - at, 40);
                xml_.fail(offset, "'" + std::string(at, shown) + "' is no finite number");
            }
            column.values.push_back(value);
            at = word_end;
        }
    }

    int integer(const Column& column, std::size_t k, double least, double most,
                const char* what) const {
        const double x = column.values[k];
        if (x != std::floor(x) || x < least || x > most)
            xml_.fail(column.offset, std::string(what) + " " + std::to_string(k) + " is " +
                                         shortest(x) + ", out of range");
        return static_cast<int>(x);
    }

    void check_cell_data(const Piece& piece, std::size_t line_count) const {
        for (const auto& [column, name] :
             {std::pair(&piece.arc, "arc"), {&piece.weight, "weight"}, {&piece.state, "state"}})
            if (column->is_there && column->values.size() < piece.vertex_cells + line_count)
                xml_.fail(column->offset,
                          std::string("cell data '") + name + "' has " +
                              std::to_string(column->values.size()) + " values for " +
                              std::to_string(piece.vertex_cells + line_count) + " cells");
    }

    std::vector<std::string> reasons(const Piece& piece) const {
        std::vector<std::string> strings(1);
        for (std::size_t k = 0; k < piece.reason.values.size(); ++k) {
            const int code = integer(piece.reason, k, 0, 255, "character");
            if (code == 0)
                strings.emplace_back();
            else
                strings.back() += static_cast<char>(code);
        }
        strings.pop_back();
        return strings;
    }

    void add(const Piece& piece) {
        if (piece.points.values.size() % 3 != 0)
            xml_.fail(piece.points.offset, "the number of coordinates is no multiple of 3");
        const int base = static_cast<int>(soup_.points.size());
        for (std::size_t k = 0; k + 2 < piece.points.values.size(); k += 3)
            soup_.points.emplace_back(piece.points.values[k], piece.points.values[k + 1],
                                      piece.points.values[k + 2]);
        const double point_count = static_cast<double>(piece.points.values.size() / 3);
        const double corner_count = static_cast<double>(piece.connectivity.values.size());
        const std::size_t line_count = piece.offsets.values.size();
        check_cell_data(piece, line_count);
        const std::vector<std::string> reason = reasons(piece);
        int begin = 0;
        for (std::size_t c = 0; c < line_count; ++c) {
            const int end = integer(piece.offsets, c, begin, corner_count, "offset");
            std::vector<int> indices;
            for (int k = begin; k < end; ++k)
                indices.push_back(base +
                                  integer(piece.connectivity, k, 0, point_count - 1, "corner"));
            begin = end;
            add_cell(piece, piece.vertex_cells + c, indices, reason);
        }
    }

    void add_cell(const Piece& piece, std::size_t cell, const std::vector<int>& indices,
                  const std::vector<std::string>& reason) {
        constexpr double kLargest = std::numeric_limits<int>::max();
        const int arc = piece.arc.is_there ? integer(piece.arc, cell, -1, kLargest, "arc") : -1;
        if (!piece.state.is_there || piece.state.values[cell] != 0) {
            soup_.add_polyline(indices, arc);
            return;
        }
        if (indices.size() < 2) return;
        DroppedPiece dropped;
        for (int point : indices) dropped.polyline.push_back(soup_.points[point]);
        dropped.origin_arc = arc;
        if (cell < reason.size()) dropped.reason = reason[cell];
        if (piece.weight.is_there) dropped.weight = piece.weight.values[cell];
        soup_.dropped.push_back(std::move(dropped));
    }

    XmlScanner xml_;
    EdgeSoup soup_;
};

struct Cell {
    std::vector<int> points;
    int arc = -1;
    double weight = 0;
    int state = 1;
    std::string reason;
    const DroppedPiece* dropped = nullptr;
};

/// The blocker that weighs most; the first of equals.
const Blocker* main_blocker(const Cell& cell) {
    if (cell.dropped == nullptr || cell.dropped->blockers.empty()) return nullptr;
    return &*std::ranges::max_element(cell.dropped->blockers, {}, &Blocker::weight);
}

std::vector<Cell> cells_to_write(const WrittenNetwork& network) {
    std::vector<Cell> cells;
    for (std::size_t a = 0; a < network.arcs.size(); ++a) {
        const WrittenNetwork::Arc& arc = network.arcs[a];
        for (std::size_t k = 0; k < arc.weights.size(); ++k) {
            if (k == 0 || arc.segments[k] != arc.segments[k - 1])
                cells.push_back(
                    {{arc.points[k]}, static_cast<int>(a), arc.weights[k], 1, "", nullptr});
            cells.back().points.push_back(arc.points[k + 1]);
        }
    }
    int point = static_cast<int>(network.points.size());
    for (const DroppedPiece& piece : network.dropped) {
        Cell cell{{}, piece.origin_arc, piece.weight, 0, piece.reason, &piece};
        for (std::size_t k = 0; k < piece.polyline.size(); ++k) cell.points.push_back(point++);
        cells.push_back(std::move(cell));
    }
    return cells;
}

template <typename Write>
void write_array(TextWriter& out, std::string_view type, std::string_view name,
                 const Write& write) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"ascii\">\n";
    write();
    out << "</DataArray>\n";
}

template <typename Text>
void write_strings(TextWriter& out, std::string_view name, const std::vector<Cell>& cells,
                   const Text& text_of) {
    write_array(out, "String", name, [&] {
        for (const Cell& cell : cells) {
            for (const char c : text_of(cell))
                out << static_cast<int>(static_cast<unsigned char>(c)) << ' ';
            out << "0\n";
        }
    });
}

void write_cell_data(TextWriter& out, const std::vector<Cell>& cells) {
    out << "<CellData Scalars=\"state\">\n";
    write_array(out, "Int32", "arc", [&] {
        for (const Cell& cell : cells) out << cell.arc << '\n';
    });
    write_array(out, "Float64", "weight", [&] {
        for (const Cell& cell : cells) out << cell.weight << '\n';
    });
    write_array(out, "Int32", "state", [&] {
        for (const Cell& cell : cells) out << cell.state << '\n';
    });
    write_strings(out, "reason", cells, [](const Cell& cell) { return cell.reason; });
    write_array(out, "Float64", "margin", [&] {
        for (const Cell& cell : cells)
            out << (cell.dropped && cell.dropped->margin ? *cell.dropped->margin : -1.0) << '\n';
    });
    write_array(out, "Int32", "blocker_arc", [&] {
        for (const Cell& cell : cells)
            out << (main_blocker(cell) ? main_blocker(cell)->origin_arc : -1) << '\n';
    });
    write_array(out, "Float64", "blocker_weight", [&] {
        for (const Cell& cell : cells)
            out << (main_blocker(cell) ? main_blocker(cell)->weight : 0.0) << '\n';
    });
    write_strings(out, "blocker_conflict", cells, [](const Cell& cell) {
        return main_blocker(cell) ? main_blocker(cell)->conflict : std::string();
    });
    out << "</CellData>\n";
}

}  // namespace

EdgeSoup read_vtp_lines(std::string_view content, const std::string& source) {
    return VtpLines(content, source).run();
}

std::string write_vtp_lines(const WrittenNetwork& network) {
    const std::vector<Cell> cells = cells_to_write(network);
    std::size_t point_count = network.points.size();
    for (const DroppedPiece& piece : network.dropped) point_count += piece.polyline.size();
    TextWriter out;
    out << "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\""
           " header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\""
        << point_count << "\" NumberOfVerts=\"0\" NumberOfLines=\"" << cells.size()
        << "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
    write_cell_data(out, cells);
    out << "<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\""
           " format=\"ascii\">\n";
    for (const Vec3& point : network.points) out << point << '\n';
    for (const DroppedPiece& piece : network.dropped)
        for (const Vec3& point : piece.polyline) out << point << '\n';
    out << "</DataArray>\n</Points>\n<Lines>\n";
    write_array(out, "Int64", "connectivity", [&] {
        for (const Cell& cell : cells)
            for (std::size_t k = 0; k < cell.points.size(); ++k)
                out << cell.points[k] << (k + 1 < cell.points.size() ? ' ' : '\n');
    });
    write_array(out, "Int64", "offsets", [&] {
        std::size_t end = 0;
        for (const Cell& cell : cells) out << (end += cell.points.size()) << '\n';
    });
    out << "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
    return out.take();
}

}  // namespace fcn
