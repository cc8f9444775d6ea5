from validation.contact.refinement_levels import LEVELS


rule contact_level:
    "Contact at one resolution"
    output:
        table="results/{case}/benchmarks/contact/{level}.csv",
        manifest="results/{case}/benchmarks/contact/{level}.provenance.json",
    threads: 2
    resources:
        mem_mb=9000,
        runtime=60,
    params:
        **values_of("tooth_pair", "contact"),
    script:
        "../scripts/contact_level.py"


rule contact_growth:
    "Time of contact against positions and loads"
    output:
        table="results/{case}/benchmarks/contact_growth.csv",
        manifest="results/{case}/benchmarks/contact_growth.provenance.json",
    threads: 2
    resources:
        mem_mb=3000,
    params:
        **values_of("tooth_pair", "contact"),
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
    script:
        "../scripts/contact_benchmark.py"


rule contact_shortcuts:
    "What shortcuts do to the stiffness"
    output:
        table="results/{case}/benchmarks/contact_shortcuts.csv",
        manifest="results/{case}/benchmarks/contact_shortcuts.provenance.json",
    threads: 2
    resources:
        mem_mb=4000,
        runtime=60,
    params:
        **values_of("tooth_pair"),
    script:
        "../scripts/contact_shortcuts.py"


rule twin_benchmark:
    "Plane-strain twin against brute-force contact"
    output:
        table="results/{case}/benchmarks/twin.csv",
        manifest="results/{case}/benchmarks/twin.provenance.json",
    threads: 2
    resources:
        mem_mb=4000,
        runtime=60,
    params:
        **values_of("tooth_pair"),
    script:
        "../scripts/twin_benchmark.py"


rule calculix_peer:
    "The same contact by CalculiX"
    output:
        table="results/{case}/benchmarks/calculix.csv",
        manifest="results/{case}/benchmarks/calculix.provenance.json",
    threads: 2
    resources:
        mem_mb=12000,
        runtime=240,
    params:
        **values_of("tooth_pair"),
    script:
        "../scripts/calculix_peer.py"


rule calculix_stress_peer:
    "Fillet stress by CalculiX"
    output:
        table="results/{case}/benchmarks/calculix_stress.csv",
        manifest="results/{case}/benchmarks/calculix_stress.provenance.json",
    threads: 2
    params:
        **values_of("tooth_pair"),
    script:
        "../scripts/calculix_stress_peer.py"


rule body_peer:
    "Natural frequencies of a gear body by CalculiX"
    output:
        table="results/{case}/benchmarks/calculix_body.csv",
        manifest="results/{case}/benchmarks/calculix_body.provenance.json",
    threads: 2
    script:
        "../scripts/body_peer.py"


rule tooth_layer_peer:
    "Natural frequencies of gear bodies with their real teeth"
    output:
        table="results/{case}/benchmarks/cyclic_teeth.csv",
        manifest="results/{case}/benchmarks/cyclic_teeth.provenance.json",
    threads: 2
    script:
        "../scripts/tooth_layer_peer.py"


rule kratos_peer:
    "Hertz's contact by Kratos"
    output:
        table="results/{case}/benchmarks/kratos_hertz.csv",
        manifest="results/{case}/benchmarks/kratos_hertz.provenance.json",
    threads: 2
    script:
        "../scripts/kratos_peer.py"


rule pair_peer:
    "The pair by three programs"
    output:
        table="results/{case}/benchmarks/pair_peer.csv",
        manifest="results/{case}/benchmarks/pair_peer.provenance.json",
    params:
        **values_of("tooth_pair"),
    script:
        "../scripts/pair_peer.py"
