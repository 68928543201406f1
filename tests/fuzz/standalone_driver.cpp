// Runs a fuzz target without libFuzzer: `target RUNS FOLDER [FIRST]` feeds every file of the folder
// as it is and then RUNS mutants of them, the same ones every time (mutant number FIRST onwards). A
// crash or an exception that escapes leaves the input in `<target>.crash` and tells its number.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestInput = 1 << 16;

const std::string* current_input = nullptr;
char crash_file[512];
char current_number[32];

/// Only async-signal-safe calls: the heap may be broken.
void save_current_input() {
    const int descriptor = ::open(crash_file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (descriptor >= 0 && current_input != nullptr) {
        [[maybe_unused]] const auto written =
            ::write(descriptor, current_input->data(), current_input->size());
        ::close(descriptor);
    }
    const char* const texts[] = {"input ", current_number, " failed, saved as ", crash_file, "\n"};
    for (const char* text : texts) {
        [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
    }
}

void on_signal(int signal) {
    save_current_input();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

class Mutator {
public:
    Mutator(const std::vector<std::string>& seeds, std::uint64_t number)
        : seeds_(seeds), engine_(0x9e3779b97f4a7c15ULL * (number + 1)) {}

    std::string mutant() {
        std::string text = seeds_[below(seeds_.size())];
        for (std::size_t i = 0, count = 1 + below(6); i < count; ++i) mutate(text);
        if (text.size() > kLargestInput) text.resize(kLargestInput);
        return text;
    }

private:
    std::size_t below(std::size_t count) { return count == 0 ? 0 : engine_() % count; }

    void mutate(std::string& text) {
        const std::size_t place = below(text.size() + 1);
        const std::size_t length = 1 + below(below(4) == 0 ? 64 : 6);
        switch (below(9)) {
            case 0:
                if (place < text.size()) text[place] ^= static_cast<char>(1 << below(8));
                break;
            case 1:
                if (place < text.size()) text[place] = static_cast<char>(below(256));
                break;
            case 2:
                text.erase(place, length);
                break;
            case 3:
                text.insert(place, text.substr(below(text.size() + 1), length));
                break;
            case 4:
                text.resize(place);
                break;
            case 5:
                insert_word(text, place);
                break;
            case 6:
                replace_number(text, place);
                break;
            case 7: {
                const std::string& other = seeds_[below(seeds_.size())];
                text = text.substr(0, place) + other.substr(below(other.size() + 1));
                break;
            }
            case 8:
                swap_lines(text, place);
                break;
        }
    }

    std::string word() {
        static const char* const kWords[] = {"0",          "-1",         "1",
                                             "2147483647", "2147483648", "4294967295",
                                             "nan",        "inf",        "-0",
                                             "1e308",      "1e-320",     "99999999999999999999",
                                             "0.5",        "\n",         " ",
                                             "\"",         "{",          "}",
                                             "[",          "]",          ",",
                                             "#",          ":",          "null",
                                             "-",          "1e60",       "\xff\xff\xff\xff",
                                             "true",       "3",          "1000000000"};
        return kWords[below(std::size(kWords))];
    }

    void insert_word(std::string& text, std::size_t place) {
        text.insert(place, below(2) == 0 ? word() : word().append(" "));
    }

    /// The run of digits at or behind a place becomes another number.
    void replace_number(std::string& text, std::size_t place) {
        const std::size_t begin = text.find_first_of("0123456789", place);
        if (begin == std::string::npos) return;
        std::size_t end = text.find_first_not_of("0123456789.", begin);
        if (end == std::string::npos) end = text.size();
        text.replace(begin, end - begin, below(2) == 0 ? word() : std::to_string(below(20)));
    }

    void swap_lines(std::string& text, std::size_t place) {
        const std::size_t begin = text.find('\n', place);
        if (begin == std::string::npos) return;
        const std::size_t middle = text.find('\n', begin + 1);
        if (middle == std::string::npos) return;
        const std::string line = text.substr(begin, middle - begin);
        text.erase(begin, middle - begin);
        text.insert(below(text.size() + 1), line);
    }

    const std::vector<std::string>& seeds_;
    std::mt19937_64 engine_;
};

void run(const std::string& input, const std::string& number) {
    current_input = &input;
    std::strncpy(current_number, number.c_str(), sizeof current_number - 1);
    try {
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    } catch (const std::exception& error) {
        std::cerr << "exception: " << error.what() << "\n";
        save_current_input();
        std::exit(1);
    }
}

std::vector<std::string> read_seeds(const fs::path& folder) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> seeds;
    for (const fs::path& path : paths) {
        std::ifstream in(path, std::ios::binary);
        seeds.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return seeds;
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count < 3) {
        std::cerr << "usage: " << arguments[0] << " RUNS FOLDER [FIRST]\n";
        return 2;
    }
    const std::string name = fs::path(arguments[0]).filename().string() + ".crash";
    std::strncpy(crash_file, name.c_str(), sizeof crash_file - 1);
    for (int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, on_signal);

    const std::uint64_t run_count = std::strtoull(arguments[1], nullptr, 10);
    const std::uint64_t first = argument_count > 3 ? std::strtoull(arguments[3], nullptr, 10) : 0;
    const std::vector<std::string> seeds = read_seeds(arguments[2]);
    if (seeds.empty()) {
        std::cerr << arguments[2] << ": no seed files\n";
        return 2;
    }
    for (std::size_t i = 0; i < seeds.size(); ++i) run(seeds[i], "seed " + std::to_string(i));
    for (std::uint64_t i = first; i < first + run_count; ++i) {
        run(Mutator(seeds, i).mutant(), std::to_string(i));
    }
    std::cout << seeds.size() << " seeds and " << run_count << " mutants passed\n";
    return 0;
}
