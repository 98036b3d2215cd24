# The page with all that it includes, as a C++ string: cmake -DPAGE=page.html -DOUTPUT=PageTemplate.cpp -P embed.cmake
# A line "@include FILE" stands for the file.
get_filename_component(folder "${PAGE}" DIRECTORY)
file(READ "${PAGE}" page)
string(REGEX MATCHALL "@include [^\n]+" includes "${page}")
foreach(include IN LISTS includes)
  string(REPLACE "@include " "" name "${include}")
  file(READ "${folder}/${name}" content)
  string(REPLACE "${include}\n" "${content}\n" page "${page}")
endforeach()
# Before and after the data.
string(REPLACE "\n@data\n" ")PAGE\";\nstatic const char End[] = R\"PAGE(" page "${page}")
file(WRITE "${OUTPUT}" "namespace tungsten {\nstatic const char Start[] = R\"PAGE(${page})PAGE\";\nconst char* pageStart() { return Start; }\nconst char* pageEnd() { return End; }\n}\n")
