include: "functions/stiffness.smk"


rule stiffness:
    "Mesh stiffness"
    input:
        unpack(stiffness_input),
    output:
        tvms="results/{case}/stiffness/tvms.csv",
        harmonics="results/{case}/stiffness/harmonics.csv",
        spectrum="results/{case}/stiffness/spectrum.csv",
        manifest="results/{case}/stiffness/stiffness.provenance.json",
    script:
        "../scripts/stiffness.py"


rule load_dependence:
    "Stiffness against load"
    input:
        ltca=shared("contact", "ltca"),
    output:
        table="results/{case}/stiffness/load_dependence.csv",
        manifest="results/{case}/stiffness/load_dependence.provenance.json",
    script:
        "../scripts/load_dependence.py"


rule stiffness_figures:
    "Mesh stiffness over a period, and its harmonics"
    input:
        tvms=shared("stiffness", "tvms"),
        spectrum=shared("stiffness", "spectrum"),
    output:
        **pictures("mesh_stiffness", "mesh_stiffness", "stiffness_harmonics"),
        manifest="results/{case}/figures/stiffness.provenance.json",
    script:
        "../scripts/stiffness_figures.py"


rule load_dependence_figure:
    "Picture of stiffness against load"
    input:
        table=rules.load_dependence.output.table,
    output:
        **pictures("mesh_stiffness", "stiffness_load"),
        manifest="results/{case}/figures/stiffness_load.provenance.json",
    script:
        "../scripts/load_dependence_figure.py"
