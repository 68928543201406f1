#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace experiment {

/// A cell of a table: what is shown, and the number by which its column sorts.
struct TableCell {
    std::string text;
    std::optional<double> number;
    bool is_best = false;  ///< the best of its column: shown in bold

    TableCell(std::string t) : text(std::move(t)) {}
    TableCell(const char* t) : text(t) {}
    TableCell(std::string t, double n) : text(std::move(t)) {
        if (!std::isnan(n)) number = n;
    }
};

/// Rectangular: as many cells in each row as there are columns.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<TableCell>> rows;
    std::string caption;
    bool is_long = false;  ///< folded away in HTML, its first rows alone in Markdown
};

/// A plot, by the name of its file without ending.
struct Figure {
    std::string name, caption;
};

struct Paragraph {
    std::string text;
};

struct BulletList {
    std::vector<std::string> items;
};

/// What is to be typed.
struct CommandLine {
    std::string text;
};

using Block = std::variant<Paragraph, BulletList, CommandLine, Table, Figure>;

struct Section {
    std::string title, id;
    std::vector<Block> blocks;
};

/// A report, before it becomes Markdown or HTML. Texts are plain, nothing in them is markup.
struct Document {
    std::string title;
    std::string lead;       ///< one line below the title
    bool is_alarm = false;  ///< in red
    std::vector<Section> sections;
};

}  // namespace experiment
