# cmake -DREADME=README.md -DOUT=snippet.inc -P extract_snippet.cmake: the integration snippet.
cmake_minimum_required(VERSION 3.25)
file(READ ${README} text)
string(REGEX MATCH "<!-- snippet: integration -->\n```cpp\n([^`]*)```" unused "${text}")
if(CMAKE_MATCH_1 STREQUAL "")
  message(FATAL_ERROR "${README} has no integration snippet")
endif()
# List separators would be lost.
file(WRITE ${OUT} "${CMAKE_MATCH_1}")
