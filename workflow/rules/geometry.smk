rule geometry:
    "Tooth geometry"
    output:
        pair="results/{case}/geometry/pair.json",
        flanks="results/{case}/geometry/flanks.npz",
        contact="results/{case}/geometry/contact.npz",
        manifest="results/{case}/geometry/geometry.provenance.json",
    script:
        "../scripts/geometry.py"


rule tooth_pair_figure:
    "Pictures of the tooth pair"
    input:
        pair=shared("geometry", "pair"),
        flanks=shared("geometry", "flanks"),
        contact=shared("geometry", "contact"),
    output:
        **pictures("teeth", "tooth_pair", "tooth_sections", "separation"),
        manifest="results/{case}/figures/tooth_pair.provenance.json",
    script:
        "../scripts/tooth_pair_figure.py"


rule cad:
    "Exact teeth for CAD"
    output:
        step="results/{case}/cad/{body}.step",
        stl="results/{case}/cad/{body}.stl",
        manifest="results/{case}/cad/{body}.provenance.json",
    wildcard_constraints:
        body="pinion|face_gear",
    script:
        "../scripts/cad.py"
