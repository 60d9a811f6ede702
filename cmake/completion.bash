# Completion of accrete in bash. It has no list of its own: it asks the program for its commands and flags, so that it
# fits whichever version is run.

_accrete_flags() { # [COMMAND]
  # shellcheck disable=SC2086 # an empty command is no argument
  "$_accrete_program" $1 --help 2>/dev/null | sed -n 's/^  \(-[A-Za-z],\)\{0,1\}\(--[a-z-]*\).*/\2/p'
}

# Of the flag $2 of the command $1, the kind of its value: FILE, N, ...; nothing where it takes none.
_accrete_kind() {
  # shellcheck disable=SC2086
  "$_accrete_program" $1 --help 2>/dev/null |
    sed -n -e "s/^  \(-[A-Za-z],\)\{0,1\}$2 \([A-Za-z:=]*\)\( .*\)\{0,1\}$/\2/p" -e "s/^  $2,--[a-z-]* \([A-Za-z:=]*\) .*/\1/p"
}

_accrete() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} _accrete_program=${COMP_WORDS[0]} command kind
  local commands
  commands=$("$_accrete_program" --help 2>/dev/null | sed -n '/^Subcommands:$/,/^$/s/^  \([a-z]*\) .*/\1/p')
  COMPREPLY=()
  if [ "$COMP_CWORD" = 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "$commands $(_accrete_flags '')" -- "$current")
    return
  fi
  command=${COMP_WORDS[1]}
  case " ${commands//$'\n'/ } " in *" $command "*) ;; *) return ;; esac
  case $before in
    -*)
      kind=$(_accrete_kind "$command" "$before")
      case $kind in
        '') ;; # it takes no value
        FILE | FOLDER | DIR)
          compopt -o filenames 2>/dev/null
          mapfile -t COMPREPLY < <(compgen -f -- "$current")
          return
          ;;
        *) return ;;
      esac
      ;;
  esac
  case $current in
    -*) mapfile -t COMPREPLY < <(compgen -W "$(_accrete_flags "$command")" -- "$current") ;;
    *)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -f -- "$current")
      ;;
  esac
}
complete -F _accrete accrete
