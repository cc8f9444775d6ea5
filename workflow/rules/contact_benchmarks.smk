include: "functions/contact_benchmarks.smk"


rule contact_rung:
    output:
        table="results/{case}/benchmarks/contact/{rung}.csv",
        manifest="results/{case}/benchmarks/contact/{rung}.provenance.json",
    log:
        "results/{case}/logs/contact_rung_{rung}.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact_rung_{rung}.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=9000,
        runtime=60,
    params:
        tooth_pair=config_slice("tooth_pair"),
        contact=config_slice("contact"),
        code=fingerprint("contact_rung.py"),
    message:
        "contact at resolution {wildcards.rung} of {wildcards.case}"
    script:
        "../scripts/contact_rung.py"


rule contact_growth:
    output:
        table="results/{case}/benchmarks/contact_growth.csv",
        manifest="results/{case}/benchmarks/contact_growth.provenance.json",
    log:
        "results/{case}/logs/contact_growth.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact_growth.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=3000,
        runtime=10,
    params:
        tooth_pair=config_slice("tooth_pair"),
        contact=config_slice("contact"),
        code=fingerprint("contact_growth.py"),
    message:
        "time of contact against positions and loads of {wildcards.case}"
    script:
        "../scripts/contact_growth.py"


rule contact_benchmark:
    input:
        tables=expand("results/{{case}}/benchmarks/contact/{rung}.csv", rung=RUNGS),
        growth="results/{case}/benchmarks/contact_growth.csv",
    output:
        table="results/{case}/benchmarks/contact.csv",
        svg="results/{case}/figures/contact_speed_error.svg",
        png="results/{case}/figures/contact_speed_error.png",
        manifest="results/{case}/benchmarks/contact.provenance.json",
    log:
        "results/{case}/logs/contact_benchmark.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact_benchmark.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 1
    resources:
        mem_mb=700,
        runtime=5,
    params:
        code=fingerprint("contact_benchmark.py"),
    message:
        "speed against error of contact of {wildcards.case}"
    script:
        "../scripts/contact_benchmark.py"


rule contact_shortcuts:
    output:
        table="results/{case}/benchmarks/contact_shortcuts.csv",
        manifest="results/{case}/benchmarks/contact_shortcuts.provenance.json",
    log:
        "results/{case}/logs/contact_shortcuts.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact_shortcuts.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=4000,
        runtime=60,
    params:
        tooth_pair=config_slice("tooth_pair"),
        code=fingerprint("contact_shortcuts.py"),
    message:
        "what shortcuts do to the stiffness of {wildcards.case}"
    script:
        "../scripts/contact_shortcuts.py"


rule twin_benchmark:
    output:
        table="results/{case}/benchmarks/twin.csv",
        manifest="results/{case}/benchmarks/twin.provenance.json",
    log:
        "results/{case}/logs/twin_benchmark.log",
    benchmark:
        "results/{case}/benchmarks/rules/twin_benchmark.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=4000,
        runtime=60,
    params:
        tooth_pair=config_slice("tooth_pair"),
        code=fingerprint("twin_benchmark.py"),
    message:
        "plane-strain twin against brute-force contact"
    script:
        "../scripts/twin_benchmark.py"


rule calculix_peer:
    output:
        table="results/{case}/benchmarks/calculix.csv",
        manifest="results/{case}/benchmarks/calculix.provenance.json",
    log:
        "results/{case}/logs/calculix_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/calculix_peer.tsv"
    conda:
        "../envs/facegear.yaml"
    threads: 2
    resources:
        mem_mb=12000,
        runtime=240,
    params:
        tooth_pair=config_slice("tooth_pair"),
        code=fingerprint("calculix_peer.py"),
    message:
        "the same contact by CalculiX for {wildcards.case}"
    script:
        "../scripts/calculix_peer.py"


rule peers:
    input:
        f"results/{CASE}/benchmarks/calculix.csv",
