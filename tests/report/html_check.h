#pragma once

#include <cctype>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fcn::test {

struct HtmlTag {
    std::string name;
    bool is_closing = false;
    std::map<std::string, std::string> attributes;  ///< values as written, not unescaped
};

/// What a strict reader finds wrong with an HTML text, and its tags.
struct HtmlCheck {
    std::vector<std::string> problems;
    std::vector<HtmlTag> tags;
    std::string text;  ///< everything between tags, style sheets excluded
};

class HtmlReader {
public:
    explicit HtmlReader(const std::string& html) : html_(html) {}

    HtmlCheck check() {
        static const std::string kDoctype = "<!DOCTYPE html>";
        if (html_.compare(0, kDoctype.size(), kDoctype) != 0) problem("no doctype");
        at_ = html_.find('>') + 1;
        while (at_ < html_.size()) {
            if (html_[at_] == '<')
                read_tag();
            else
                read_text();
        }
        for (const std::string& tag : open_) problem("<" + tag + "> is not closed");
        return std::move(result_);
    }

private:
    void problem(const std::string& what) {
        result_.problems.push_back(what + " at " + std::to_string(at_));
    }

    void read_text() {
        const std::size_t end = std::min(html_.find('<', at_), html_.size());
        const bool is_style = !open_.empty() && open_.back() == "style";
        for (std::size_t i = at_; i < end && !is_style; ++i) {
            if (html_[i] == '>') problem("bare > in text");
            if (html_[i] == '&') check_entity(i);
        }
        if (!is_style) result_.text += html_.substr(at_, end - at_);
        at_ = end;
    }

    void check_entity(std::size_t i) {
        static const std::set<std::string> known{"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
        const std::size_t end = html_.find(';', i);
        if (end == std::string::npos || !known.count(html_.substr(i, end - i + 1)))
            problem("bare & in text");
    }

    void read_tag() {
        static const std::set<std::string> empty{"img", "meta", "br", "hr", "link", "input"};
        ++at_;
        HtmlTag tag;
        tag.is_closing = at_ < html_.size() && html_[at_] == '/';
        if (tag.is_closing) ++at_;
        tag.name = read_name();
        if (tag.name.empty()) problem("bare <");
        while (at_ < html_.size() && html_[at_] != '>') read_attribute(tag);
        ++at_;
        if (tag.is_closing) {
            if (open_.empty() || open_.back() != tag.name)
                problem("</" + tag.name + "> closes nothing");
            else
                open_.pop_back();
        } else if (!empty.count(tag.name)) {
            open_.push_back(tag.name);
        }
        result_.tags.push_back(std::move(tag));
    }

    std::string read_name() {
        std::string name;
        while (at_ < html_.size() &&
               (std::isalnum(static_cast<unsigned char>(html_[at_])) || html_[at_] == '-'))
            name += html_[at_++];
        return name;
    }

    void read_attribute(HtmlTag& tag) {
        if (html_[at_] == ' ') {
            ++at_;
            return;
        }
        const std::string name = read_name();
        if (name.empty() || html_.compare(at_, 2, "=\"") != 0) {
            problem("broken attribute in <" + tag.name + ">");
            at_ = std::min(html_.find('>', at_), html_.size());
            return;
        }
        at_ += 2;
        const std::size_t end = std::min(html_.find('"', at_), html_.size());
        const std::string value = html_.substr(at_, end - at_);
        if (value.find('<') != std::string::npos) problem("bare < in an attribute");
        for (std::size_t i = at_; i < end; ++i)
            if (html_[i] == '&') check_entity(i);
        if (!tag.attributes.emplace(name, value).second) problem("attribute " + name + " twice");
        at_ = end + 1;
    }

    const std::string& html_;
    std::size_t at_ = 0;
    std::vector<std::string> open_;
    HtmlCheck result_;
};

inline HtmlCheck check_html(const std::string& html) { return HtmlReader(html).check(); }

}  // namespace fcn::test
