# PEGTL is a header-only library without a package file of its own in some versions: only its headers are needed.
find_path(PEGTL_INCLUDE_DIR tao/pegtl.hpp REQUIRED)
target_include_directories(puppetri_lang SYSTEM PRIVATE "${PEGTL_INCLUDE_DIR}")
