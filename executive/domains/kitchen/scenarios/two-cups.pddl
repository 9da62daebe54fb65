; Two cups from behind the cutlery of one table and of the counter, and back to the dock: 13 actions.
(define (problem two-cups)
  (:domain kitchen)
  (:objects dock table1 table2 counter table3 home - place cup1 cup2 - cup)
  (:init (robot-at dock) (cup-at cup1 table1) (cup-at cup2 counter) (hand-empty) (arm-home) (free table2) (free table3))
  (:goal (and (cup-at cup1 table2) (cup-at cup2 table3) (robot-at home))))
