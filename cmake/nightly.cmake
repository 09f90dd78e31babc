# Tests that take minutes: counts over many fits, and whole studies. `scripts/test` leaves them out, `scripts/test
# --nightly` and CI run them too. Each pattern is one of gtest's, in the test program of its folder; of what it counts a
# faster law stays in the default run.
set(nightly_recovery "NozzleMismatch.IsTuned*:Twins.CommonShift*")  # whole tunes of the virtual rig
set(nightly_hidden "HiddenStudy.*")                                 # some thirty explanations each
set(nightly_diagnose "MainJob.LostWire*")                           # a baseline and the verdicts on it
set(nightly_python notebooks workflow)                              # five notebooks; a study by Snakemake
