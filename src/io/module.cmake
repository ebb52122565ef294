# Number formatting; no compiled library of fmt is wanted.
find_package(fmt REQUIRED)
target_link_libraries(puppetri_io PRIVATE fmt::fmt-header-only)
# XML of PNML, PIPE and the contest's queries. Debian's package and pugixml's own name the target differently.
find_package(pugixml REQUIRED)
target_link_libraries(puppetri_io PRIVATE pugixml::pugixml)
# Witnesses are read back.
find_package(nlohmann_json REQUIRED)
target_link_libraries(puppetri_io PRIVATE nlohmann_json::nlohmann_json)
