#pragma once

#include <filesystem>
#include <string>

namespace experiment {

/// A program of this project: beside this one, else by PATH, else the bare name.
std::filesystem::path own_program(const std::string& name);

/// Hash of the content of a program of ours; computed once.
std::string program_hash(const std::string& name);

/// The Python that has the solvers' packages: LABELING_PYTHON, build/solvers-venv, python3.
std::string python_for_solvers();

/// The Python that has matplotlib: SCALEFCN_PYTHON, build/experiments-venv, python3.
std::string python_for_plots();

/// Folder of this project's sources, or of what was installed of them.
std::filesystem::path source_folder();

}  // namespace experiment
