#!/usr/bin/env bash
# Checks the include library with POV-Ray as the judge: every file parses alone and without a warning,
# every name of names.tsv is declared by its file, and every name can be used as the kind that names.tsv says.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if ! command -v povray >/dev/null; then
    echo "check.sh: SKIPPED, povray is not installed"
    exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Our files are copied to the folder of the scenes, and an own povray.ini hides the installed library.
cp "$here"/*.inc "$work"
echo "Library_Path=$work" >"$work/povray.ini"
export POVINI="$work/povray.ini"
cd "$work"
failed=0

# run NAME FILE: parses and renders one pixel; fails on an error, or on a warning that is not about the test scene itself.
run() {
    if ! povray -D -F +W1 +H1 -A "+I$2" >"$work/log" 2>&1; then
        echo "check.sh: $1 does not parse:"
        grep -aE -A3 "Error" "$work/log" | head -4
        failed=1
    elif grep -aE "(Parse|Possible).*(Warning|Error)" "$work/log" | grep -avqE "No objects in scene|More than one camera|experimental feature"; then
        echo "check.sh: $1 gives warnings:"
        grep -aE -A2 "(Parse|Possible).*Warning" "$work/log" | head -4
        failed=1
    fi
}

head='#version 3.7;
global_settings { assumed_gamma 1 }
camera { location -9*z look_at 0 }
box { -1, 1 pigment { rgb 1 } }'

for file in *.inc; do
    names=$(awk -F'\t' -v f="$file" '$2 == f { print $1 "\t" $3 }' "$here/names.tsv")
    {
        echo "$head"
        echo "#include \"$file\""
        echo "#ifndef (Strahl_Include_Version) #error \"$file: not ours\" #end"
        while IFS=$'\t' read -r name kind; do
            [ -n "$name" ] || continue
            echo "#ifndef ($name) #error \"$file: $name is not declared\" #end"
            case $kind in
                texture | pigment | finish | material | interior | sky_sphere | object | transform)
                    echo "#declare Used = $kind { $name }" ;;
                color_map) echo "#declare Used = pigment { bozo color_map { $name } }" ;;
                color) echo "#declare Used = pigment { color $name }" ;;
                vector) echo "#declare Used = vlength(<0, 0, 0> + $name);" ;;
                float) echo "#declare Used = $name + 1;" ;;
                seed) echo "#declare Used = rand($name);" ;;
                function | macro) ;;
                *) echo "#error \"$file: $name has the unknown kind $kind\"" ;;
            esac
        done <<<"$names"
    } >scene.pov
    run "$file" scene.pov
    # A second include must be harmless, and every object, texture and material must also render.
    {
        echo "$head"
        echo "#include \"$file\" #include \"$file\""
        while IFS=$'\t' read -r name kind; do
            case $kind in
                texture) echo "sphere { 0, 1 texture { $name } }" ;;
                pigment) echo "sphere { 0, 1 pigment { $name } }" ;;
                material) echo "sphere { 0, 1 material { $name } }" ;;
                object) echo "object { $name pigment { rgb 1 } }" ;;
            esac
        done <<<"$names"
    } >scene.pov
    run "$file (rendered)" scene.pov
done

cp "$here/check_macros.pov" scene.pov
run "the macros" scene.pov

[ "$failed" = 0 ] && echo "check.sh: $(ls ./*.inc | wc -l) files and $(($(wc -l <"$here/names.tsv") - 1)) names are in order"
exit "$failed"
