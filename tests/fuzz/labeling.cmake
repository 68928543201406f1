# The readers of labeling problems and solutions: every input goes to all of them.
scalefcn_add_fuzz_target(labeling_reader_fuzz SOURCES labeling_reader_fuzz.cpp LINK labeling
                         RUNS 20000)

# The proof checker: a problem, a line "=" and a proof.
scalefcn_add_fuzz_target(proof_fuzz SOURCES proof_fuzz.cpp LINK labeling RUNS 20000)
