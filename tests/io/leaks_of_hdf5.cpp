/// HDF5 1.10 leaks the parsed part of a damaged object header. LeakSanitizer calls this function by
/// name.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions();
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
