from validation.contact.refinement_levels import LEVELS


rule contact_level:
    "Contact at one resolution"
    output:
        table="results/{case}/benchmarks/contact/{level}.csv",
        manifest="results/{case}/benchmarks/contact/{level}.provenance.json",
    log:
        "results/{case}/logs/contact_level_{level}.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact_level_{level}.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=9000,
        runtime=60,
    params:
        **values_of("tooth_pair", "contact"),
        code=code("validation/scripts/contact_level.py"),
    script:
        "../scripts/contact_level.py"


rule contact_growth:
    "Time of contact against positions and loads"
    output:
        table="results/{case}/benchmarks/contact_growth.csv",
        manifest="results/{case}/benchmarks/contact_growth.provenance.json",
    log:
        "results/{case}/logs/contact_growth.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact_growth.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=3000,
    params:
        **values_of("tooth_pair", "contact"),
        code=code("validation/scripts/contact_growth.py"),
    script:
        "../scripts/contact_growth.py"


rule contact_benchmark:
    "Speed against error of contact"
    input:
        tables=expand("results/{{case}}/benchmarks/contact/{level}.csv", level=LEVELS),
        growth=rules.contact_growth.output.table,
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
        ENVIRONMENT
    params:
        code=code("validation/scripts/contact_benchmark.py"),
    script:
        "../scripts/contact_benchmark.py"


rule contact_shortcuts:
    "What shortcuts do to the stiffness"
    output:
        table="results/{case}/benchmarks/contact_shortcuts.csv",
        manifest="results/{case}/benchmarks/contact_shortcuts.provenance.json",
    log:
        "results/{case}/logs/contact_shortcuts.log",
    benchmark:
        "results/{case}/benchmarks/rules/contact_shortcuts.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=4000,
        runtime=60,
    params:
        **values_of("tooth_pair"),
        code=code("validation/scripts/contact_shortcuts.py"),
    script:
        "../scripts/contact_shortcuts.py"


rule twin_benchmark:
    "Plane-strain twin against brute-force contact"
    output:
        table="results/{case}/benchmarks/twin.csv",
        manifest="results/{case}/benchmarks/twin.provenance.json",
    log:
        "results/{case}/logs/twin_benchmark.log",
    benchmark:
        "results/{case}/benchmarks/rules/twin_benchmark.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=4000,
        runtime=60,
    params:
        **values_of("tooth_pair"),
        code=code("validation/scripts/twin_benchmark.py"),
    script:
        "../scripts/twin_benchmark.py"


rule calculix_peer:
    "The same contact by CalculiX"
    output:
        table="results/{case}/benchmarks/calculix.csv",
        manifest="results/{case}/benchmarks/calculix.provenance.json",
    log:
        "results/{case}/logs/calculix_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/calculix_peer.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=12000,
        runtime=240,
    params:
        **values_of("tooth_pair"),
        code=code("validation/scripts/calculix_peer.py"),
    script:
        "../scripts/calculix_peer.py"


rule calculix_stress_peer:
    "Fillet stress by CalculiX"
    output:
        table="results/{case}/benchmarks/calculix_stress.csv",
        manifest="results/{case}/benchmarks/calculix_stress.provenance.json",
    log:
        "results/{case}/logs/calculix_stress_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/calculix_stress_peer.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    params:
        **values_of("tooth_pair"),
        code=code("validation/scripts/calculix_stress_peer.py"),
    script:
        "../scripts/calculix_stress_peer.py"


rule body_peer:
    "Natural frequencies of a gear body by CalculiX"
    output:
        table="results/{case}/benchmarks/calculix_body.csv",
        manifest="results/{case}/benchmarks/calculix_body.provenance.json",
    log:
        "results/{case}/logs/body_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/body_peer.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    params:
        code=code("validation/scripts/body_peer.py"),
    script:
        "../scripts/body_peer.py"


rule tooth_layer_peer:
    "Natural frequencies of gear bodies with their real teeth"
    output:
        table="results/{case}/benchmarks/cyclic_teeth.csv",
        manifest="results/{case}/benchmarks/cyclic_teeth.provenance.json",
    log:
        "results/{case}/logs/tooth_layer_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/tooth_layer_peer.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    params:
        code=code("validation/scripts/tooth_layer_peer.py"),
    script:
        "../scripts/tooth_layer_peer.py"


rule kratos_peer:
    "Hertz's contact by Kratos"
    output:
        table="results/{case}/benchmarks/kratos_hertz.csv",
        manifest="results/{case}/benchmarks/kratos_hertz.provenance.json",
    log:
        "results/{case}/logs/kratos_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/kratos_peer.tsv"
    conda:
        ENVIRONMENT
    threads: 2
    params:
        code=code("validation/scripts/kratos_peer.py"),
    script:
        "../scripts/kratos_peer.py"


rule pair_peer:
    "The pair by three programs"
    output:
        table="results/{case}/benchmarks/pair_peer.csv",
        manifest="results/{case}/benchmarks/pair_peer.provenance.json",
    log:
        "results/{case}/logs/pair_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/pair_peer.tsv"
    conda:
        ENVIRONMENT
    params:
        **values_of("tooth_pair"),
        code=code("validation/scripts/pair_peer.py"),
    script:
        "../scripts/pair_peer.py"


rule family_peer:
    "A helical and a tapered pair by three programs"
    input:
        "config/helical.yaml",
        "config/tapered.yaml",
        "config/concentric.yaml",
    output:
        table="results/{case}/benchmarks/family_peer.csv",
        manifest="results/{case}/benchmarks/family_peer.provenance.json",
    log:
        "results/{case}/logs/family_peer.log",
    benchmark:
        "results/{case}/benchmarks/rules/family_peer.tsv"
    conda:
        ENVIRONMENT
    resources:
        runtime=60,
    params:
        code=code("validation/scripts/family_peer.py"),
    script:
        "../scripts/family_peer.py"
