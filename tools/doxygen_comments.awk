# Doxygen's filter of a public header: plain C comments become documentation. A comment on lines of its own belongs to what
# follows, a comment after code to that code, and the file's first comment to the file. Rulers ("/* ---- ...") stay plain.
# "type a, b; /* ... */" says b, and of a that b says it.
BEGIN { file = 1 }
/^\/\* / && file { sub(/^\/\* /, "/** @file\n * "); file = 0; print; next }
/\/\* ----/ { print; next }
/^[ \t]*\/\* / { sub(/\/\* /, "/** "); print; next }
/^ +[A-Za-z0-9_]+ [A-Za-z0-9]+, [A-Za-z0-9]+; +\/\* / {
  split($0, part, /[ ,;]+/) # part[1] is empty
  printf "  %s %s; /**< See %s. */ ", part[2], part[3], part[4]
  sub(/[A-Za-z0-9]+, /, "")
}
/[^ \t].*\/\* / { sub(/\/\* /, "/**< "); print; next }
{ print }
