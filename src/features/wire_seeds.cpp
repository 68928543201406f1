// The file of a user's wires. Unknown keys are errors, so that misspelt ones do not pass.

#include <nlohmann/json.hpp>

#include "features/wire.h"
#include "geometry/errors.h"
#include "network/json_cursor.h"

namespace fcn {
namespace {

WireRequest read_wire(const JsonCursor& at, const std::string& file_name) {
    at.expect_object({"points", "vertices", "closed", "pin"});
    WireRequest wire;
    wire.place = file_name + ": " + at.pointer();
    if (at.has("points") == at.has("vertices")) at.fail("either points or vertices");
    if (at.has("points")) {
        const JsonCursor points = at.at("points");
        const std::size_t count = points.expect_array();
        for (std::size_t k = 0; k < count; ++k) {
            const JsonCursor point = points.element(k);
            point.expect_array(3);
            wire.points.emplace_back(point.element(0).number(), point.element(1).number(),
                                     point.element(2).number());
        }
    } else {
        const JsonCursor vertices = at.at("vertices");
        const std::size_t count = vertices.expect_array();
        for (std::size_t k = 0; k < count; ++k)
            wire.vertices.push_back(vertices.element(k).integer(0));
    }
    if (at.has("closed")) wire.is_closed = at.at("closed").boolean();
    if (at.has("pin")) wire.is_pinned = at.at("pin").boolean();
    return wire;
}

}  // namespace

std::vector<WireRequest> read_wires(const std::string& text, const std::string& file_name) {
    nlohmann::json document;
    try {
        document = nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& error) {
        std::string what = error.what();  // "[json.exception...] parse error at line 3, ..."
        const std::size_t prefix = what.find("] ");
        if (prefix != std::string::npos) what = what.substr(prefix + 2);
        throw InputError(file_name + ": " + what);
    }
    const JsonCursor root(document, file_name);
    root.expect_object({"wires"});
    const JsonCursor list = root.at("wires");
    const std::size_t count = list.expect_array();
    if (count == 0) throw InputError(file_name + ": /wires: there is no wire");
    std::vector<WireRequest> wires;
    for (std::size_t k = 0; k < count; ++k) wires.push_back(read_wire(list.element(k), file_name));
    return wires;
}

}  // namespace fcn
