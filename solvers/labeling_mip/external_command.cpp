#include "labeling_mip/external_command.h"

#include "labeling/errors.h"

namespace labeling {
namespace {

class TemplateReader {
public:
    TemplateReader(std::string_view command, const std::map<std::string, std::string>& values)
        : command_(command), values_(values) {}

    std::vector<std::string> run() {
        for (; at_ < command_.size(); ++at_) step(command_[at_]);
        if (quote_ != 0) fail("an open quote");
        if (is_bracketed_) fail("an open bracket");
        end_word();
        return std::move(words_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError("command '" + std::string(command_) + "': " + what);
    }

    void step(char c) {
        if (c == quote_ || (quote_ == 0 && (c == '"' || c == '\''))) {
            quote_ = quote_ == 0 ? c : char{0};
            has_word_ = true;
        } else if (c == '{') {
            place();
        } else if (quote_ != 0) {
            word_ += c;
        } else if (c == ' ' || c == '\t') {
            end_word();
        } else if (c == '[') {
            if (is_bracketed_) fail("a bracket inside of a bracket");
            end_word();
            is_bracketed_ = true;
            first_of_bracket_ = words_.size();
            lacks_value_ = false;
        } else if (c == ']') {
            if (!is_bracketed_) fail("a bracket that was not opened");
            end_word();
            if (lacks_value_) words_.resize(first_of_bracket_);
            is_bracketed_ = false;
        } else {
            word_ += c;
            has_word_ = true;
        }
    }

    void place() {
        const std::size_t end = command_.find('}', at_);
        if (end == std::string_view::npos) fail("an open brace");
        const std::string name(command_.substr(at_ + 1, end - at_ - 1));
        const auto it = values_.find(name);
        if (it == values_.end()) fail("unknown placeholder {" + name + "}");
        if (it->second.empty()) {
            if (!is_bracketed_) fail("{" + name + "} has no value here; put it into [ ]");
            lacks_value_ = true;
        }
        word_ += it->second;
        has_word_ = true;
        at_ = end;
    }

    void end_word() {
        if (has_word_) words_.push_back(word_);
        word_.clear();
        has_word_ = false;
    }

    std::string_view command_;
    const std::map<std::string, std::string>& values_;
    std::vector<std::string> words_;
    std::string word_;
    std::size_t at_ = 0, first_of_bracket_ = 0;
    char quote_ = 0;  ///< the one that is open
    bool is_bracketed_ = false, has_word_ = false, lacks_value_ = false;
};

}  // namespace

std::vector<std::string> command_words(std::string_view command,
                                       const std::map<std::string, std::string>& values) {
    return TemplateReader(command, values).run();
}

}  // namespace labeling
