// A solver may fork, detach and ignore signals. The process that runs it adopts whatever it leaves
// behind (PR_SET_CHILD_SUBREAPER), so that everything it ever started is found below this process
// and can be ended: nothing of one run disturbs the next.
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

namespace experiment {
namespace {

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
    constexpr int kMostRounds = 200;
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

}  // namespace experiment
