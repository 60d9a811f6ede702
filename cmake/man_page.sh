#!/bin/sh
# man_page.sh OUT [EMULATOR] PROGRAM: the manual page of the program, made of what its own --help prints.
set -eu
out=$1
shift
trap 'rm -f "$out.part"' EXIT

# What --help prints, as troff; `kind` is "program" or the name of a command.
as_troff() {
  awk -v kind="$1" '
    function plain(s) {
      gsub(/\\/, "\\e", s); gsub(/-/, "\\-", s)
      if (s ~ /^[.\047]/) s = "\\&" s
      return s
    }
    function entry(s,   n) {  # "-o,--out FOLDER": flags bold, the kind of value in italics
      n = index(s, " ")
      if (n == 0) return "\\fB" plain(s) "\\fR"
      return "\\fB" plain(substr(s, 1, n - 1)) "\\fR \\fI" plain(substr(s, n + 1)) "\\fR"
    }
    NR == 1 { about = $0; next }
    /^Usage: / {
      if (kind == "program") print ".SH SYNOPSIS\n\\fBaccrete\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n" plain(about)
      else print ".SH \"ACCRETE " toupper(kind) "\"\n" plain(about) ".\n.PP\n\\fB" plain(substr($0, 8)) "\\fR"
      next
    }
    /^Examples$/ { print ".SS Examples\n.nf"; verbatim = 1; footer = 1; next }
    verbatim && /^$/ { print ".fi"; verbatim = 0; next }
    verbatim { print plain(substr($0, 3)); next }
    /^$/ { if (footer) print ".PP"; next }
    footer && /^Exit status: / { print ".SS Exit status\n" plain(substr($0, 14)); next }
    footer { print plain($0); next }
    /^[^ ].*:$/ { print ".SS \"" plain(substr($0, 1, length($0) - 1)) "\""; next }
    /^  [^ ]/ {
      rest = substr($0, 3); text = ""
      if (length($0) > 30) { text = substr($0, 31); rest = substr($0, 3, 28) }
      if (length($0) > 30 && substr($0, 30, 1) != " ") { rest = substr($0, 3); text = "" }  # its text follows below
      sub(/ +$/, "", rest)
      print ".TP\n" entry(rest)
      if (text != "") print plain(text)
      next
    }
    { sub(/^ +/, ""); print plain($0) }
    END { if (verbatim) print ".fi" }'
}

program_help=$("$@" --help)
version=$("$@" --version)
footer=$(printf '%s\n' "$program_help" | sed -n '/^Examples$/,$p')
{
  printf '.\\" Made of the output of accrete --help by cmake/man_page.sh\n'
  printf '.TH ACCRETE 1 "" "%s" "User Commands"\n' "$version"
  printf '.SH NAME\naccrete \\- 3D models of edges from stereo images of something that moves\n'
  printf '%s\n' "$program_help" | as_troff program
  for command in $(printf '%s\n' "$program_help" | sed -n '/^Subcommands:$/,/^$/s/^  \([a-z][a-z]*\) .*/\1/p'); do
    command_help=$("$@" "$command" --help)
    own=$(printf '%s\n' "$command_help" | sed -n '/^Examples$/,$p')
    if [ "$own" = "$footer" ]; then # it has none of its own
      command_help=$(printf '%s\n' "$command_help" | sed '/^Examples$/,$d')
    fi
    printf '%s\n' "$command_help" | as_troff "$command"
  done
} >"$out.part"
mv "$out.part" "$out"
