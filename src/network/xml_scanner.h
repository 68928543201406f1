#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fcn {

/// One step through an XML text: a start tag, an end tag, or the text between tags. Comments,
/// processing instructions and the document type are passed over; entities are not expanded.
struct XmlEvent {
    enum class Kind { Start, End, Text, EndOfFile };
    struct Attribute {
        std::string_view name, value;
    };
    Kind kind = Kind::EndOfFile;
    std::string_view name;  ///< of a tag
    std::string_view text;  ///< of a text
    std::vector<Attribute> attributes;
    bool is_empty = false;   ///< no end tag follows
    std::size_t offset = 0;  ///< of the tag or text in the whole

    std::string_view attribute(std::string_view name) const;  ///< empty when absent
};

/// As much XML as data files need. The text must outlive the scanner and its events.
class XmlScanner {
public:
    XmlScanner(std::string_view text, std::string source) : text_(text), source_(source) {}
    XmlEvent next();
    /// Throws InputError "<source>:<line of offset>: <what>".
    [[noreturn]] void fail(std::size_t offset, const std::string& what) const;

private:
    void skip_past(std::string_view end, const char* what);
    XmlEvent read_tag();

    std::string_view text_;
    std::string source_;
    std::size_t position_ = 0;
};

}  // namespace fcn
