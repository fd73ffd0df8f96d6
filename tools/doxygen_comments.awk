# Doxygen's filter of a public header: plain C comments become documentation. A comment on lines of its own belongs to what
# follows, a comment after code to that code, and the file's first comment to the file. Rulers ("/* ---- ...") stay plain.
# "type a, b;" documents a; b refers to a.
BEGIN { file = 1 }
/^\/\* / && file { sub(/^\/\* /, "/** @file\n * "); file = 0; print; next }
/\/\* ----/ { print; next }
/^[ \t]*\/\* / { sub(/\/\* /, "/** "); print; next }
/^ +[A-Za-z0-9_]+ [A-Za-z0-9_]+, [A-Za-z0-9_, ]+;$/ {
  count = split($0, part, /[ ,;]+/) # part[1] and part[count] are empty
  printf "  %s %s;", part[2], part[3]
  for (i = 4; i < count; ++i) printf " %s %s; /**< See %s. */", part[2], part[i], part[3]
  print ""
  next
}
/[^ \t].*\/\* / { sub(/\/\* /, "/**< "); print; next }
{ print }
