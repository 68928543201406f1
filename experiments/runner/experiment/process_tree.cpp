// A solver may fork, detach and ignore signals. The process that runs it adopts whatever it leaves
// behind (PR_SET_CHILD_SUBREAPER), so that everything it ever started is found below this process
// and can be ended: nothing of one run disturbs the next. When that process itself was killed, what
// is left is known by its environment, which a process cannot change once it has started.
#include "experiment/process_tree.h"

#include <dirent.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

namespace experiment {
namespace {

constexpr int kMostRounds = 200;

struct Process {
    pid_t id = 0, parent = 0;
    bool is_dead = false;  ///< ended, not reaped yet
};

/// The name in the second field of /proc/N/stat may hold anything, brackets and blanks too.
bool read_process(const char* number, Process& process) {
    std::ifstream file(std::string("/proc/") + number + "/stat");
    std::string line;
    if (!std::getline(file, line)) return false;
    const std::size_t end = line.rfind(')');
    if (end == std::string::npos || end + 4 >= line.size()) return false;
    process.id = static_cast<pid_t>(std::atol(number));
    process.is_dead = line[end + 2] == 'Z';
    process.parent = static_cast<pid_t>(std::atol(line.c_str() + end + 4));
    return true;
}

std::vector<Process> all_processes() {
    std::vector<Process> processes;
    DIR* folder = ::opendir("/proc");
    if (folder == nullptr) return processes;
    while (const dirent* entry = ::readdir(folder)) {
        Process process;
        const bool is_number = entry->d_name[0] >= '0' && entry->d_name[0] <= '9';
        if (is_number && read_process(entry->d_name, process)) processes.push_back(process);
    }
    ::closedir(folder);
    return processes;
}

/// Was it started with a TMPDIR below `folder`, given with a slash at its end?
bool is_of(pid_t process, const std::string& folder) {
    std::ifstream file("/proc/" + std::to_string(process) + "/environ", std::ios::binary);
    for (std::string variable; std::getline(file, variable, '\0');) {
        if (variable.starts_with("TMPDIR=")) {
            return std::string_view(variable).substr(7).starts_with(folder);
        }
    }
    return false;
}

}  // namespace

void adopt_orphans() { ::prctl(PR_SET_CHILD_SUBREAPER, 1); }

std::vector<pid_t> descendants(pid_t root) {
    std::multimap<pid_t, pid_t> children;
    for (const Process& p : all_processes()) {
        if (!p.is_dead) children.emplace(p.parent, p.id);
    }
    std::vector<pid_t> found{root};
    for (std::size_t k = 0; k < found.size(); ++k) {
        const auto [from, to] = children.equal_range(found[k]);
        for (auto it = from; it != to; ++it) found.push_back(it->second);
    }
    found.erase(found.begin());
    return found;
}

double resident_mib(const std::vector<pid_t>& processes) {
    double pages = 0;
    for (const pid_t process : processes) {
        std::ifstream file("/proc/" + std::to_string(process) + "/statm");
        double size = 0, resident = 0;
        if (file >> size >> resident) pages += resident;
    }
    return pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024 * 1024);
}

int kill_descendants() {
    std::vector<pid_t> left;
    for (int round = 0; round < kMostRounds; ++round) {
        while (::waitpid(-1, nullptr, WNOHANG) > 0) {
        }
        left = descendants(::getpid());
        if (left.empty()) return 0;
        for (const pid_t process : left) ::kill(process, SIGKILL);
        ::poll(nullptr, 0, 5);
    }
    return static_cast<int>(left.size());
}

void kill_processes_of(const std::filesystem::path& folder) {
    const std::string prefix = std::filesystem::weakly_canonical(folder).string() + "/";
    for (int round = 0; round < kMostRounds; ++round) {
        bool is_clear = true;
        for (const Process& p : all_processes()) {
            if (p.is_dead || p.id == ::getpid() || !is_of(p.id, prefix)) continue;
            is_clear = false;
            ::kill(p.id, SIGKILL);
        }
        if (is_clear) return;
        ::poll(nullptr, 0, 5);
    }
}

}  // namespace experiment
