# XML of SCXML. Debian's package and pugixml's own name the target alike.
find_package(pugixml REQUIRED)
target_link_libraries(puppetri_notation PRIVATE pugixml::pugixml)
