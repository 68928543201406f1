// A short run of the network fuzz target without a fuzzing engine: files of every format, mutated
// at random. Usage: network_fuzz [RUNS] [SEED]. A failure prints its input's seed and aborts.

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "fuzz/network_fuzz.h"
#include "network/network_formats.h"
#include "network/network_io.h"
#include "network/sample_networks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using namespace fcn;
using namespace fcn::testing;

std::vector<std::string> seed_files() {
    std::vector<std::string> files;
    const auto add = [&](std::size_t name, const std::string& content) {
        for (int with_mesh : {0, 1})
            files.push_back(std::string(1, static_cast<char>(2 * name + with_mesh)) + content);
    };
    const LoadedMesh mesh = cube_mesh(2);
    for (const FeatureCurveNetwork& network :
         {cube(3), adapted_cube(), circle(5, {0.5, 0.5, 1}, 0.25), t_junction(), lasso()}) {
        add(0, network_to_json(network));
        const WrittenNetwork written = polylines_to_write(network, NetworkDetail::Segments);
        add(1, write_obj_lines(written));
        add(2, write_ply_edges(written));
        add(3, write_vtp_lines(written));
        add(4, write_medit_edges(written));
        add(5, write_gmsh_lines(written));
        add(8, write_polylines(written));
    }
    const WrittenNetwork edges = polylines_to_write(cube(3), NetworkDetail::DenseArcs);
    add(6, write_sharp(edges, mesh.mesh, "seed"));
    add(7, write_fl(edges, mesh.mesh, "seed"));
    add(2, std::string("ply\nformat binary_little_endian 1.0\nelement vertex 2\n"
                       "property float x\nproperty float y\nproperty float z\nelement edge 1\n"
                       "property uchar vertex1\nproperty uchar vertex2\nend_header\n") +
               std::string(23, '\0') + "\x3f\1" + '\0');
    add(5,
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n1 3 0 2\n1\n2\n0 0 0\n1 0 0\n"
        "$EndNodes\n$Elements\n1 1 1 1\n1 3 1 1\n1 1 2\n$EndElements\n");
    return files;
}

class Mutator {
public:
    Mutator(std::uint64_t seed, const std::vector<std::string>& files)
        : engine_(seed), files_(files) {}

    std::string mutated() {
        std::string file = files_[draw(files_.size())];
        for (std::size_t count = 1 + draw(4); count > 0; --count) mutate(file);
        return file;
    }

private:
    std::size_t draw(std::size_t bound) { return engine_() % bound; }

    void mutate(std::string& file) {
        static const std::vector<std::string> kTokens{"nan",
                                                      "-1",
                                                      "1e999",
                                                      "4294967296",
                                                      "-9223372036854775808",
                                                      "18446744073709551615",
                                                      "0",
                                                      "\n",
                                                      " ",
                                                      "1e-400",
                                                      "{",
                                                      "]",
                                                      "<",
                                                      ",",
                                                      "null",
                                                      "true",
                                                      "0x10",
                                                      "$End"};
        const std::size_t at = 1 + draw(file.size());
        const std::size_t length = std::min(file.size() - at, draw(20));
        switch (draw(7)) {
            case 0:
                if (at < file.size()) file[at] = static_cast<char>(engine_());
                break;
            case 1:
                if (at < file.size()) file[at] ^= static_cast<char>(1 << draw(8));
                break;
            case 2:
                file.erase(at, length);
                break;
            case 3:
                file.insert(at, file.substr(at, length));
                break;
            case 4:
                file.replace(at, std::min(length, std::size_t{3}), kTokens[draw(18)]);
                break;
            case 5:
                if (draw(4) == 0) file.resize(at);
                break;
            default: {
                const std::string& other = files_[draw(files_.size())];
                const std::size_t from = draw(other.size());
                file.insert(at, other.substr(from, draw(60)));
            }
        }
    }

    std::mt19937_64 engine_;
    const std::vector<std::string>& files_;
};

std::uint64_t current_seed = 0;

void report(int) {
    std::fprintf(stderr, "failed: network_fuzz 1 %llu\n",
                 static_cast<unsigned long long>(current_seed));
    std::_Exit(1);
}

}  // namespace

int main(int argc, char** argv) {
    const std::uint64_t runs = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 20000;
    const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
    const std::vector<std::string> files = seed_files();
    std::signal(SIGABRT, report);  // an exception that escapes ends in abort, too
    std::signal(SIGSEGV, report);
    for (const std::string& file : files)
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
    for (std::uint64_t run = 0; run < runs; ++run) {
        current_seed = first + run;
        const std::string file = Mutator(current_seed, files).mutated();
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
    }
    std::printf("%llu mutated files from seed %llu\n", static_cast<unsigned long long>(runs),
                static_cast<unsigned long long>(first));
    return 0;
}
