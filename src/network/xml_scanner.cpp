#include "network/xml_scanner.h"

#include <algorithm>

#include "geometry/errors.h"

namespace fcn {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

std::string_view XmlEvent::attribute(std::string_view wanted) const {
    for (const Attribute& a : attributes)
        if (a.name == wanted) return a.value;
    return {};
}

void XmlScanner::fail(std::size_t offset, const std::string& what) const {
    const std::string_view before = text_.substr(0, offset);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    throw InputError(source_ + ":" + std::to_string(line) + ": " + what);
}

void XmlScanner::skip_past(std::string_view end, const char* what) {
    const std::size_t found = text_.find(end, position_);
    if (found == std::string_view::npos) fail(position_, std::string(what) + " does not end");
    position_ = found + end.size();
}

XmlEvent XmlScanner::next() {
    while (position_ < text_.size()) {
        const std::string_view rest = text_.substr(position_);
        if (rest.starts_with("<!--")) {
            skip_past("-->", "a comment");
        } else if (rest.starts_with("<?")) {
            skip_past("?>", "a processing instruction");
        } else if (rest.starts_with("<!")) {
            skip_past(">", "a declaration");
        } else if (rest.front() == '<') {
            return read_tag();
        } else {
            XmlEvent event;
            event.kind = XmlEvent::Kind::Text;
            event.offset = position_;
            const std::size_t end = std::min(text_.find('<', position_), text_.size());
            event.text = text_.substr(position_, end - position_);
            position_ = end;
            return event;
        }
    }
    return {};
}

XmlEvent XmlScanner::read_tag() {
    XmlEvent event;
    event.offset = position_;
    const auto at_end = [&] { return position_ >= text_.size(); };
    const auto fail_end = [&] { fail(event.offset, "a tag does not end"); };
    const auto skip_spaces = [&] {
        while (!at_end() && is_space(text_[position_])) ++position_;
        if (at_end()) fail_end();
    };
    const auto name = [&] {
        const std::size_t begin = position_;
        while (!at_end() && !is_space(text_[position_]) &&
               std::string_view("=/><\"'").find(text_[position_]) == std::string_view::npos)
            ++position_;
        if (at_end()) fail_end();
        if (position_ == begin) fail(position_, "expected a name within a tag");
        return text_.substr(begin, position_ - begin);
    };
    ++position_;
    event.kind = XmlEvent::Kind::Start;
    if (!at_end() && text_[position_] == '/') {
        event.kind = XmlEvent::Kind::End;
        ++position_;
    }
    event.name = name();
    for (skip_spaces(); text_[position_] != '>'; skip_spaces()) {
        if (text_[position_] == '/') {
            event.is_empty = true;
            ++position_;
            continue;
        }
        XmlEvent::Attribute attribute;
        attribute.name = name();
        skip_spaces();
        if (text_[position_] != '=') fail(position_, "expected '=' after an attribute's name");
        ++position_;
        skip_spaces();
        const char quote = text_[position_];
        if (quote != '"' && quote != '\'') fail(position_, "an attribute's value has no quotes");
        const std::size_t end = text_.find(quote, ++position_);
        if (end == std::string_view::npos) fail_end();
        attribute.value = text_.substr(position_, end - position_);
        position_ = end + 1;
        event.attributes.push_back(attribute);
    }
    ++position_;
    return event;
}

}  // namespace fcn
