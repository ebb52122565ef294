# Number formatting; no compiled library of fmt is wanted.
find_package(fmt REQUIRED)
target_link_libraries(puppetri_io PRIVATE fmt::fmt-header-only)
