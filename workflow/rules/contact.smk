rule contact:
    input:
        pinion="results/{case}/compliance/pinion.npz",
        face_gear="results/{case}/compliance/face_gear.npz",
    output:
        ltca="results/{case}/contact/ltca.csv",
        pressure="results/{case}/contact/pressure.npz",
        vtu="results/{case}/contact/pressure.vtu",
        manifest="results/{case}/contact/contact.provenance.json",
    log:
        "results/{case}/logs/contact.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=4000,
        runtime=30,
    params:
        tooth_pair=config_slice("tooth_pair"),
        mesh=config_slice("mesh"),
        contact=config_slice("contact"),
        code=fingerprint("contact.py"),
    message:
        "loaded tooth contact of {wildcards.case}"
    script:
        "../scripts/contact.py"


rule contact_figures:
    input:
        ltca=upstream("contact", "contact/ltca.csv"),
        pressure=upstream("contact", "contact/pressure.npz"),
    output:
        curves_svg=report(
            "results/{case}/figures/contact_curves.svg",
            caption="../report/contact.rst",
            category="Contact",
            labels={"figure": "contact_curves"},
        ),
        curves_png="results/{case}/figures/contact_curves.png",
        pattern_svg=report(
            "results/{case}/figures/contact_pattern.svg",
            caption="../report/contact.rst",
            category="Contact",
            labels={"figure": "contact_pattern"},
        ),
        pattern_png="results/{case}/figures/contact_pattern.png",
        manifest="results/{case}/figures/contact.provenance.json",
    log:
        "results/{case}/logs/contact_figures.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact_figures.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        code=fingerprint("contact_figures.py"),
    message:
        "contact figures of {wildcards.case}"
    script:
        "../scripts/contact_figures.py"
