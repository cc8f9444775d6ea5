include: "functions/modal.smk"


rule modal:
    "Natural frequencies and mode shapes"
    input:
        unpack(modal_input),
    output:
        frequencies="results/{case}/modal/frequencies.csv",
        shapes="results/{case}/modal/shapes.csv",
        contacts="results/{case}/modal/contacts.csv",
        manifest="results/{case}/modal/modal.provenance.json",
    script:
        "../scripts/modal.py"


rule ratings:
    "Gear ratio, speeds, torques and powers"
    input:
        harmonics=shared("stiffness", "harmonics"),
    output:
        ratings="results/{case}/machine/ratings.csv",
        bodies="results/{case}/machine/bodies.csv",
        meshes="results/{case}/machine/meshes.csv",
        manifest="results/{case}/machine/machine.provenance.json",
    script:
        "../scripts/ratings.py"


rule modal_figure:
    "Typical mode shapes"
    input:
        frequencies=rules.modal.output.frequencies,
        shapes=rules.modal.output.shapes,
    output:
        **pictures("modes", "mode_shapes"),
        manifest="results/{case}/figures/mode_shapes.provenance.json",
    script:
        "../scripts/modal_figure.py"
