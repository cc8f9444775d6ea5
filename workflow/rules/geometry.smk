rule geometry:
    output:
        pair="results/{case}/geometry/pair.json",
        flanks="results/{case}/geometry/flanks.npz",
        contact="results/{case}/geometry/contact.npz",
        manifest="results/{case}/geometry/geometry.provenance.json",
    log:
        "results/{case}/logs/geometry.log",
    benchmark:
        "results/{case}/benchmarks/rules/geometry.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        section=config_slice("tooth_pair"),
        code=fingerprint("geometry.py"),
    message:
        "tooth geometry of {wildcards.case}"
    script:
        "../scripts/geometry.py"


rule tooth_pair_figure:
    input:
        pair=upstream("geometry", "geometry/pair.json"),
        flanks=upstream("geometry", "geometry/flanks.npz"),
        contact=upstream("geometry", "geometry/contact.npz"),
    output:
        svg=report(
            "results/{case}/figures/tooth_pair.svg",
            caption="../report/teeth.rst",
            category="Teeth",
            labels={"figure": "tooth_pair"},
        ),
        png="results/{case}/figures/tooth_pair.png",
        manifest="results/{case}/figures/tooth_pair.provenance.json",
    log:
        "results/{case}/logs/tooth_pair_figure.log",
    benchmark:
        "results/{case}/benchmarks/rules/tooth_pair_figure.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        code=fingerprint("tooth_pair_figure.py"),
    message:
        "pictures of the tooth pair of {wildcards.case}"
    script:
        "../scripts/tooth_pair_figure.py"
