# cmake -DDOCUMENT=README.md -DSNIPPET=integration -DOUT=snippet.inc -P extract_snippet.cmake: the block after <!-- snippet: integration -->
cmake_minimum_required(VERSION 3.25)
file(READ ${DOCUMENT} text)
string(REGEX MATCH "<!-- snippet: ${SNIPPET} -->\n```[a-z]+\n([^`]*)```" unused "${text}")
if("${CMAKE_MATCH_1}" STREQUAL "")
  message(FATAL_ERROR "${DOCUMENT} has no snippet ${SNIPPET}")
endif()
# List separators would be lost.
file(WRITE ${OUT} "${CMAKE_MATCH_1}")
